"""``python -m jacaros``."""

from jacaros.runtime.cli.main import main

main()
