# make demo   sets up .venv, designs the paper's controller, and writes its report and that of a protection that works
# make test   sets up .venv with the test tools and runs the tests
# make check  formatting, types, layers, and that the generated files are current
# make derive writes the generated model and the equation map from derivations/
# make docs   builds the documentation site in out/docs, without a network; its notebooks are run
# make reports rebuilds the committed reports
# make wheels builds wheels for Linux, with compiled plants
# make bench  measures our ways against others, side by side

PYTHON ?= python3
VENV ?= .venv
OUT ?= out
BIN := $(VENV)/bin

# Containers often set this; compiled modules make every later start several times faster.
unexport PYTHONDONTWRITEBYTECODE

# What a vehicle without a radar has: pulse wheels whose periods are timed, and an accelerometer that is not exact.
SENSING := --pulses 100 --period-timing --accelerometer-noise "0.05 m/s2"
PROTECTION := reports/protection-polach-wet

.PHONY: demo demo-paper demo-protection test check style types layers compiled current derive docs reports wheels bench clean

demo: $(VENV)/.installed
	@mkdir -p $(OUT)
	$(BIN)/wspd design --rail polach-wet --output $(OUT)/er24pc.toml --force
	@$(MAKE) --no-print-directory --jobs=2 demo-paper demo-protection

demo-paper:
	$(BIN)/wspd report $(OUT)/er24pc.toml --output $(OUT)/er24pc.html --pdf --force

demo-protection:
	$(BIN)/wspd design $(PROTECTION)/specification.toml --rules-only --output $(OUT)/protection.toml --force
	$(BIN)/wspd report $(OUT)/protection.toml $(SENSING) --output $(OUT)/protection.html --pdf --force

test: $(VENV)/.installed-dev
	$(BIN)/python -m pytest

check: style types layers current

style: $(VENV)/.installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/.installed-dev
	$(BIN)/mypy

layers: $(VENV)/.installed-dev
	$(BIN)/lint-imports

# Gathers the tests once: what is compiled then, several processes that run them would compile at the same time.
compiled: $(VENV)/.installed-dev
	$(BIN)/python -m pytest --collect-only --quiet --quiet -n 0 > /dev/null

current: $(VENV)/.installed-dev
	$(BIN)/python -m derivations.generate --check

derive: $(VENV)/.installed-dev
	$(BIN)/python -m derivations.generate

docs: $(VENV)/.installed-dev
	$(BIN)/python docs/site/build.py $(OUT)/docs

# A fixed date: a report changes only when its numbers or its text do.
reports: export SOURCE_DATE_EPOCH := 1790000000
reports: $(VENV)/.installed
	$(BIN)/wspd design --rail polach-wet --output reports/er24pc-polach-wet/design.toml --force
	$(BIN)/wspd report reports/er24pc-polach-wet/design.toml --output reports/er24pc-polach-wet/report.html --force
	$(BIN)/wspd design --law torque-feedback --rail polach-wet --sample-time "20 ms" --output reports/torque-feedback-polach-wet/design.toml --force
	$(BIN)/wspd report reports/torque-feedback-polach-wet/design.toml --output reports/torque-feedback-polach-wet/report.html --force
	$(BIN)/wspd design $(PROTECTION)/specification.toml --rules-only --output $(PROTECTION)/design.toml --force
	$(BIN)/wspd report $(PROTECTION)/design.toml $(SENSING) --ladder --output $(PROTECTION)/report.html --force
	$(BIN)/wspd reproduce --output reports/paper --force

wheels: $(VENV)/.installed-dev
	$(BIN)/python wheels/build.py

bench: $(VENV)/.installed-dev
	$(BIN)/python benchmarks/run.py

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

# One installation, not a second one on top of the first. Compiled is what is imported, when it is: that is less.
$(VENV)/.installed: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --no-compile --editable .
	@touch $@

$(VENV)/.installed-dev: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --no-compile --editable ".[dev]"
	@touch $(VENV)/.installed $@

clean:
	rm -rf $(VENV) $(OUT) build *.egg-info
