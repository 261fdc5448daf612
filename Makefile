# make demo   sets up .venv, designs the ER24PC controller and writes the report
# make test   sets up .venv with the test tools and runs the tests
# make check  formatting, types and layers
# make derive writes the generated model and the equation map from derivations/
# make reports rebuilds the committed reference report

PYTHON ?= python3
VENV ?= .venv
OUT ?= out
BIN := $(VENV)/bin

# Containers often set this; compiled modules make every later start several times faster.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test check derive reports clean

demo: $(VENV)/.installed
	@mkdir -p $(OUT)
	$(BIN)/wspd design --rail polach-wet --output $(OUT)/er24pc.toml --force
	$(BIN)/wspd report $(OUT)/er24pc.toml --rail polach-wet --output $(OUT)/er24pc.html --pdf --force

test: $(VENV)/.installed-dev
	$(BIN)/python -m pytest

check: $(VENV)/.installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python -m derivations.generate --check

derive: $(VENV)/.installed-dev
	$(BIN)/python -m derivations.generate

$(VENV)/.installed: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --editable .
	@touch $@

$(VENV)/.installed-dev: $(VENV)/.installed
	$(BIN)/python -m pip install --quiet --editable ".[dev]"
	@touch $@

clean:
	rm -rf $(VENV) $(OUT) build *.egg-info
