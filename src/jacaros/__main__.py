"""``python -m jacaros``."""

from jacaros.cli.main import main

main()
