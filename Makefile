# make demo    a venv, the package, and a robot that patrols on the embedded world; under two minutes
# make test    everything, ROS 1 and ROS 2 included (installs what that needs on Debian 12)
# make test-all    that, and all unit tests again with every other Python of the machine
# make quick   what to run before a commit: style, types, layers, unit tests
# make coverage   which lines the unit, contract and conformance tests run, by package; in some fifteen minutes
# make bench   figures of speed, beside those of other engines, in some ten minutes; renews docs/benchmarks.md
#              make bench BENCH=--quick   in some three minutes, and changes nothing; JASON=/path/to/jason takes part, too
# make experiment   the experiment of docs/experiment.md, in some fifteen minutes; renews the page and its charts
# make reference   the reference pages and pictures that follow from the code
# make release   wheel, source distribution and bill of materials (CycloneDX) in dist/, the same on every machine
#
# PYTHON=python3.12 make demo     with another interpreter (3.11 or newer)
# make test PARTS="unit docs"     some parts only; `.venv/bin/python tools/test_all.py --list` names them

VENV := .venv
PYTHON ?= $(shell tools/find_python.sh)

.PHONY: demo test test-all quick coverage reference experiment bench release clean

demo: $(VENV)/.installed
	$(VENV)/bin/python tools/demo.py

test: $(VENV)/.installed-dev
	$(VENV)/bin/python tools/test_all.py $(PARTS)

test-all: $(VENV)/.installed-dev
	$(VENV)/bin/python tools/test_all.py --all

quick: $(VENV)/.installed-dev
	$(VENV)/bin/python tools/test_all.py style types layers unit

coverage: $(VENV)/.installed-dev
	$(VENV)/bin/python tools/measure_coverage.py

# The reference pages that follow from the code, and the pictures.
reference: $(VENV)/.installed-dev
	$(VENV)/bin/python tools/make_reference.py
	$(VENV)/bin/python tools/make_pictures.py

experiment: $(VENV)/.installed-dev
	$(VENV)/bin/python experiment/run.py

release: $(VENV)/.installed-dev
	rm -rf dist
	$(VENV)/bin/python tools/build_release.py dist
	$(VENV)/bin/twine check --strict dist/*
	PYTHON=$(VENV)/bin/python tools/make_sbom.sh dist

bench: $(VENV)/.installed $(VENV)-bench/.installed
	$(VENV)/bin/python benchmarks/bench.py $(BENCH)

clean:
	rm -rf $(VENV) $(VENV)-* runs build dist

$(VENV)/bin/python:
	@test -n "$(PYTHON)" || { echo "make: needs python3 >= 3.11 with venv (Debian: apt install python3-venv)" >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: pyproject.toml setup.cfg setup.py | $(VENV)/bin/python
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check -e .
	touch $@

$(VENV)/.installed-dev: pyproject.toml setup.cfg setup.py | $(VENV)/bin/python
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check -e '.[dev]'
	touch $@ $(VENV)/.installed

# Apart, as what it holds is under the GPL, or for pictures only.
$(VENV)-bench/.installed: benchmarks/requirements.txt | $(VENV)/bin/python
	$(VENV)/bin/python -m venv $(VENV)-bench
	$(VENV)-bench/bin/python -m pip install --quiet --disable-pip-version-check -r benchmarks/requirements.txt
	touch $@
