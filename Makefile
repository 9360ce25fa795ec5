# Two commands do everything on a fresh machine: make demo, make test.
PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin
STAMP  := $(VENV)/.installed
OUT    ?= demo
# Every worker and command keeps its compiled bytecode: tests start many processes.
# A worker runs whole files, in the order of tests/conftest.py: fixtures of a module are made once.
PYTEST := PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -n auto --dist loadfile --no-loadscope-reorder

.PHONY: demo serve test check static quick format docs bench install clean

install: $(STAMP)

$(STAMP): pyproject.toml
	$(PYTHON) -c 'import sys; v = sys.version_info; sys.exit(0 if v >= (3, 11) else "Thalweg needs Python 3.11 or newer, this is %d.%d: make PYTHON=python3.12 ..." % v[:2])'
	@echo "Installing Thalweg and its dependencies into $(VENV) (1 to 3 minutes) ..."
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet --editable ".[dev]"
	touch $(STAMP)

demo: $(STAMP)
	@echo "Planning the example voyage; results go to $(OUT) ..."
	$(BIN)/python -m thalweg.cli.main demo --out $(OUT)
	@echo "Next: make serve opens the web application with this voyage filled in."

serve: $(STAMP)
	$(BIN)/python -m thalweg.cli.main serve --demo --open

test: $(STAMP)
	$(PYTEST)

# The type checker has one thread: the quick tests run beside it.
check: $(STAMP)
	+$(MAKE) --no-print-directory --jobs 2 static quick

static: $(STAMP)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/lint-imports
	$(BIN)/mypy

quick: $(STAMP)
	$(PYTEST) -q -m "not slow"

format: $(STAMP)
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

docs: $(STAMP)
	$(BIN)/python docs/generate_reference.py
	$(BIN)/python docs/generate_cli_page.py

bench: $(STAMP)
	for script in benchmarks/[a-z]*.py; do echo "== $$script"; $(BIN)/python $$script || exit 1; done

clean:
	rm -rf $(VENV) demo out .pytest_cache .mypy_cache .ruff_cache .hypothesis
