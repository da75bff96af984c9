"""`python -m murkscan`: the command line."""

from .cli import main

main()
