# Two commands on a fresh machine: `make demo` and `make test`. Each does all of its own set-up.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
export PIP_DISABLE_PIP_VERSION_CHECK := 1

.PHONY: demo hello test check bench docs viewer clean

demo: hello $(VENV)/core
	@$(BIN)/murkscan demo

hello:
	@test -e $(VENV)/core || echo "Once: an environment in $(VENV) with murkscan's libraries, about 0.9 GB," \
	  "two to four minutes. Then the demo: one to two minutes."

# A run of tests a core, and one more while others wait for a browser or a stream; threads of small
# matrix products would only wait for one another.
# What the tests start compiles Python anew each time unless Python may keep what it has compiled.
test: check
	env -u PYTHONDONTWRITEBYTECODE OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest --dist loadfile \
	  --no-loadscope-reorder -n $$($(BIN)/python -c 'import os; print((os.cpu_count() or 1) + 1)')

check: $(VENV)/dev
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: $(VENV)/dev
	@set -e; for script in benchmarks/*.py; do echo "== $$script"; $(BIN)/python $$script; done

# The site of the pages, the examples (which are run) and the docstrings: docs/_build/html/index.html.
# SPHINX="-D plot_gallery=0" leaves the examples as they are, for who has run them already.
docs: $(VENV)/docs
	$(BIN)/python -m sphinx -q -W --keep-going $(SPHINX) -b html docs docs/_build/html
	@echo "Open docs/_build/html/index.html"

# The script of the page that `murkscan view` writes; committed, so that users need no node.
viewer:
	cd src/murkscan/view/viewer && npm install --no-fund --no-audit && npm run build

clean:
	rm -rf $(VENV) murkscan-demo

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 14))' || { \
	  echo "murkscan needs Python 3.11, 3.12 or 3.13; name one: make PYTHON=python3.12 demo"; exit 1; }
	@echo "Making an environment in $(VENV)."
	@$(PYTHON) -m venv $(VENV)

$(VENV)/core: $(BIN)/python pyproject.toml constraints.txt
	@echo "Installing murkscan and its libraries, about 0.9 GB: a minute or two, once."
	@$(BIN)/python -m pip install --progress-bar on --constraint constraints.txt --editable .
	@touch $@

$(VENV)/dev: $(BIN)/python pyproject.toml constraints.txt
	@echo "Installing murkscan with what checks and tests need: a minute or two, once."
	@$(BIN)/python -m pip install --progress-bar on --constraint constraints.txt --editable '.[dev]'
	@touch $@ $(VENV)/core

$(VENV)/docs: $(BIN)/python pyproject.toml constraints.txt
	@echo "Installing murkscan with what the site needs: a minute or two, once."
	@$(BIN)/python -m pip install --progress-bar on --constraint constraints.txt --editable '.[docs]'
	@touch $@ $(VENV)/core
