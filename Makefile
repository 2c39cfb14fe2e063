# make demo          venv, package, and a robot that patrols on the embedded world; under 2 minutes
# make test          all tests, including ROS 1 and ROS 2 (installs their packages on Debian 12)
# make test-all      the same, and all unit tests with every other Python of the machine
# make quick         checks before a commit: style, types, layers, unit tests
# make coverage      lines run by the unit, contract and conformance tests, by package; about 15 minutes
# make mutants       one-line changes that the tests notice; a sample, in about an hour
#                    make mutants MUTANTS="agents/mind/rules agents/terms agents/mind/state"     440 changes of the mind, in about 20 minutes
#                    make mutants MUTANTS="artifacts/robots --sample 0"   all changes of one package
# make bench         benchmarks, beside other engines, in about 10 minutes; rewrites docs/benchmarks.md
#                    make bench BENCH=--quick   about 3 minutes, writes nothing; JASON=/path/to/jason adds Jason
# make experiment    all runs of docs/experiment.md, in about 25 minutes; rewrites their record, the page and its pictures
# make reference     reference pages and pictures generated from the code
# make vsix          the VS Code extension, editors/vscode/dist/jacaros.vsix; needs Node.js 18 or later with npm
# make site          the documentation as a website in build/site; after `make live` with the robot in it
# make live          the pages on which programs run in a browser, in build/live; needs npm's registry
# make release       wheel, source distribution and bill of materials (CycloneDX) in dist/, the same on every machine
#
# PYTHON=python3.12 make demo   use another interpreter (3.11 or newer)
# make test PARTS="unit docs"   run some parts only; `.venv/bin/python tools/test_all.py --list` lists them

VENV := .venv
PYTHON ?= $(shell tools/find_python.sh)

.PHONY: demo test test-all quick coverage mutants reference experiment bench live site release vsix clean

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

mutants: $(VENV)/.installed-dev
	$(VENV)/bin/python tools/mutants.py $(MUTANTS)

# Reference pages and pictures generated from the code.
reference: $(VENV)/.installed-dev
	$(VENV)/bin/python tools/make_reference.py
	$(VENV)/bin/python tools/make_schemas.py
	$(VENV)/bin/python tools/draw_layers.py
	$(VENV)/bin/python tools/make_pictures.py

experiment: $(VENV)/.installed-dev
	$(VENV)/bin/python experiment/run.py

site: $(VENV)/.installed-dev
	$(VENV)/bin/python tools/make_site.py

live: $(VENV)/.installed-dev
	$(VENV)/bin/python tools/build_live.py build/live

release: $(VENV)/.installed-dev
	rm -rf dist
	$(VENV)/bin/python tools/build_release.py dist
	$(VENV)/bin/twine check --strict dist/*
	PYTHON=$(VENV)/bin/python tools/make_sbom.sh dist

# With the version of the package.
vsix:
	cd editors/vscode && npm ci --silent --ignore-scripts && npm run --silent package -- $$(sed -n 's/^version = "\(.*\)"/\1/p' ../../pyproject.toml)

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

# A separate venv, because its packages are under the GPL, or needed for pictures only.
$(VENV)-bench/.installed: benchmarks/requirements.txt | $(VENV)/bin/python
	$(VENV)/bin/python -m venv $(VENV)-bench
	$(VENV)-bench/bin/python -m pip install --quiet --disable-pip-version-check -r benchmarks/requirements.txt
	touch $@
