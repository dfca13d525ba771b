# make report   every case of the library, solved both ways, as a page: report/index.html
# make nightly  the same through Dask, with its history and what moved: nightly/index.html, nightly/summary.txt
# make test     the whole test suite, by two processes; by eight: make test PROCESSES=8
# make check    quick tests, ruff, mypy: under a minute
# make bench    what a solve costs
# make setup    .venv with all they need; the others call it

PYTHON ?= python3
PROCESSES ?= 2
RUN := .venv/bin
# Each process takes tests that stand together, as these share what they solve; who is done takes from the others.
PYTEST := $(RUN)/python -m pytest --numprocesses $(PROCESSES) --dist worksteal

# The rod model's blocks are small and the 3D factorisation is serial: more threads cost more than they bring.
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1

.PHONY: setup report nightly test check bench

setup:
	@command -v $(PYTHON) >/dev/null || { echo "setup: no $(PYTHON); install it (Debian, Ubuntu: apt-get install python3 python3-venv)" >&2; exit 1; }
	@$(PYTHON) tools/setup.py

report: setup
	$(RUN)/rodcheck report

nightly: setup
	$(RUN)/rodcheck nightly

test: setup
	$(PYTEST)

check: setup
	$(PYTEST) -m "not slow"
	$(RUN)/ruff check .
	$(RUN)/ruff format --check .
	$(RUN)/mypy

bench: setup
	$(RUN)/python -m pytest tests/benchmarks -o addopts="--import-mode=importlib --benchmark-only"
