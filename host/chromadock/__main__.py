"""``python -m chromadock`` is the ``chromadock`` command."""

from chromadock.cli import main

main()
