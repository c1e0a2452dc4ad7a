# Every target sets up what it needs, in .venv: Python 3.11 or newer and make are enough.
# Written for GNU make 3.81 and newer and a POSIX shell.

# The extras (see pyproject.toml) that each job is set up with; `make test TEST_EXTRAS=dev` tests without any.
TEST_EXTRAS ?= dev,fast,rerun,parquet,cluster
TEST_3D_EXTRAS ?= dev,mujoco,pybullet,ompl,baxter,meshes,video
DEMO_EXTRAS ?= rerun
PICTURES_EXTRAS ?= rerun,mujoco,ompl,baxter,meshes,video,plots,report
BENCH_EXTRAS ?= dev,fast,rerun,mujoco,pybullet,ompl,baxter
MUTATION_EXTRAS ?= dev,mutation
SCENE ?= vieira/basic
TIMES ?= 10
ROOM ?= topology
SAMPLE ?= 50
SEED ?= 0
# What is tested with phframe: plugins as their users have them, installed.
PLUGINS := plugins/phframe-lookahead
3D := needs_mujoco or needs_pybullet or needs_ompl or needs_baxter or needs_meshes or needs_video
PYTEST_FLAGS ?= --numprocesses=auto --benchmark-disable

override VENV := .venv
override PIP := $(VENV)/bin/python -m pip --disable-pip-version-check
comma := ,
stamp = $(VENV)/.ready-$(subst $(comma),-,$(1))

# Settings of the shell that would mix other packages into .venv, or install elsewhere.
unexport PYTHONPATH PYTHONHOME PIP_USER PIP_TARGET PIP_PREFIX PIP_REQUIRE_VIRTUALENV

# PyBullet has wheels for this alone; elsewhere its tests are skipped.
has_pybullet = __import__('sysconfig').get_platform() == 'linux-x86_64' and __import__('sys').version_info[:2] == (3, 11)

# An error if one is missing: its tests would be skipped.
has_plugins = import importlib.metadata as m; [m.version(name) for name in '$(notdir $(PLUGINS))'.split()]

.DEFAULT_GOAL := help
.NOTPARALLEL:
.PHONY: help demo test test-3d test-long trials mutants lint bench pictures clean interpreter FORCE

help: ## say what can be made (the default)
	@echo 'usage: make TARGET [PYTHON=/path/to/python3.11]'
	@sed -n 's/^\([a-z0-9-]*\):.*## \(.*\)/  \1	\2/p' Makefile

demo: $(call stamp,$(DEMO_EXTRAS)) ## solve a shelf scene and record it for the Rerun viewer
	@$(VENV)/bin/phframe solve $(SCENE) --rerun

# Whatever is installed, the libraries for 3D are hidden: what is tested here needs none of them.
test: $(call stamp,$(TEST_EXTRAS)) ## run the tests of all that needs no 3D engine
	@$(VENV)/bin/python -c "$(has_plugins)"
	@$(VENV)/bin/python -m pytest -p tests.without_3d $(PYTEST_FLAGS) -m 'not ($(3D)) and not long'

# What takes minutes: trials that misbehave, killed benches, a cluster, whole reports, a browser.
test-long: $(call stamp,$(TEST_EXTRAS)) ## run the long tests of benches and their reports
	@$(VENV)/bin/python -m pytest -p tests.without_3d $(PYTEST_FLAGS) -m 'not ($(3D)) and long'

# The suites of fault injection, as many times over as TIMES says; they print what they tried.
trials: $(call stamp,$(BENCH_EXTRAS)) ## try to break it, TIMES times as often as the tests do, and count the trials
	@PHFRAME_TEST_TIMES=$(TIMES) $(VENV)/bin/python -m pytest $(PYTEST_FLAGS) tests/faults tests/conformance/test_any_order.py

# Mutation testing, in a copy of the tree; the rooms are in tests/mutation/rooms.toml, and SAMPLE=0 means all mutants.
mutants: $(call stamp,$(MUTATION_EXTRAS)) ## make SAMPLE mutants of the code of ROOM and print those that its tests do not notice
	@$(VENV)/bin/python -m tests.mutation.mutants $(ROOM) --sample $(SAMPLE) --seed $(SEED)

test-3d: $(call stamp,$(TEST_3D_EXTRAS)) ## run the tests of the 3D engines and of Baxter
	@$(VENV)/bin/python -c "import av, mujoco, ompl.base, pinocchio, toppra, trimesh"
	@$(VENV)/bin/python -c "$(has_pybullet) and __import__('pybullet')"
	@$(VENV)/bin/python -m pytest $(PYTEST_FLAGS) -m '($(3D)) and not long'

lint: $(call stamp,$(TEST_EXTRAS)) ## check style, types, layers and spelling
	@$(VENV)/bin/ruff check
	@$(VENV)/bin/ruff format --check
	@$(VENV)/bin/mypy
	@$(VENV)/bin/lint-imports
	@$(VENV)/bin/codespell

bench: $(call stamp,$(BENCH_EXTRAS)) ## measure planning and simulation against bare loops
	@$(VENV)/bin/python -m phframe.bench.meters

pictures: $(call stamp,$(PICTURES_EXTRAS)) ## make every picture of README and docs anew, by Chromium and MuJoCo
	@$(VENV)/bin/python -m docs.make_pictures

clean: ## remove .venv and all caches, keep runs/
	rm -rf $(VENV) build dist .mypy_cache .pytest_cache .ruff_cache .import_linter_cache .hypothesis .benchmarks
	find phframe tests -name __pycache__ -prune -exec rm -rf {} +

# --- set-up ---

# A stamp is made last, so an interrupted set-up leaves none; .installing then tells that .venv must be made anew.
# So must one that was moved here from elsewhere, or whose interpreter is gone.
usable := $(shell test ! -e $(VENV)/.installing && $(VENV)/bin/python -c '' 2>/dev/null && cat $(VENV)/.home 2>/dev/null)
ifneq ($(usable),$(CURDIR))
    remake := FORCE
endif

$(VENV)/.ready-%: $(VENV)/.home pyproject.toml constraints.txt $(addsuffix /pyproject.toml,$(PLUGINS))
	@echo 'Installing phframe[$(subst -,$(comma),$*)] into $(VENV): up to 1.5 GB, a minute or two the first time.'
	@touch $(VENV)/.installing
	@$(PIP) install $(if $(CI),--quiet) --constraint constraints.txt --editable '.[$(subst -,$(comma),$*)]' \
	    $(if $(findstring dev,$*),$(addprefix --editable ./,$(PLUGINS)))
	@rm -f $(VENV)/.installing
	@touch $@

$(VENV)/.home: $(remake)
	@$(find_python); \
	echo "Making $(VENV) with $$python ($$("$$python" --version))."; \
	rm -rf $(VENV) && "$$python" -m venv $(VENV) && pwd -P > $@

interpreter: # the interpreter that a new .venv would be made with
	@$(find_python); echo "$$python"

# Sets $python to the first candidate that really runs, is new enough and can make virtual environments: $PYTHON, else
# a Python 3.11, else a newer one. (A pyenv shim may exist and yet fail; Debian ships ensurepip separately.)
define find_python
fits() { \
    "$$1" -c "import ensurepip, sys, venv; sys.exit(not sys.version_info[:2] $$2 (3, 11))" </dev/null >/dev/null 2>&1; \
}; \
versions="$${PYENV_ROOT:-$$HOME/.pyenv}/versions"; \
python=; \
if test -n "$$PYTHON"; then \
    if fits "$$PYTHON" '>='; then python="$$PYTHON"; else \
        echo "PYTHON=$$PYTHON does not run, is older than 3.11 or lacks venv or ensurepip: trying others." >&2; \
    fi; \
fi; \
for order in '==' '>'; do \
    for candidate in python3.11 python3 "$$versions"/3.11*/bin/python \
        python3.12 python3.13 python3.14 "$$versions"/3.1[2-9]*/bin/python; do \
        if test -z "$$python" && fits "$$candidate" "$$order"; then python="$$candidate"; fi; \
    done; \
done; \
if test -z "$$python"; then \
    echo 'error: no Python 3.11 or newer with venv and ensurepip found: install one (Debian: python3.11 and' \
        'python3.11-venv), or name one, as in: make test PYTHON=/path/to/python3.11' >&2; \
    exit 1; \
fi
endef
