# Everything starts here: `make help` lists the targets.
# Each target sets up what it needs first; what is in place already is left alone.

PYTHON ?= python3
VENV := .venv/bin

# Packages are installed without compiled modules, which Python writes when it first imports them.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help setup demo results test hil soak night image bench fuzz lint format generate contrast clean setup-demo setup-bench

help: ## List these targets
	@sed -nE 's/^([a-z]+):[^#]*## (.*)/\1\t\2/p' Makefile | expand -t 12

setup: ## Install everything that the tests need
	@$(PYTHON) tools/setup test

setup-demo:
	@$(PYTHON) tools/setup demo

demo: setup-demo ## Dock and vehicle in simulated water: out/demo/
	@$(VENV)/chromadock demo

results: setup-demo ## The paper's experiments on simulated frames: docs/results.md
	@$(VENV)/python tools/results.py

test: setup ## Run all checks and all tests
	@$(VENV)/python tools/test.py

hil: setup ## The hardware tests on the simulated dock; on a board: PORT=/dev/ttyUSB0 [BAUD=...] [FLASH=1]
	@$(VENV)/python tools/hardware.py $(if $(PORT),--port=$(PORT)) $(if $(BAUD),--baud=$(BAUD)) $(if $(FLASH),--flash)

soak: setup ## A minute of an RTSP camera, 20 kills of a recording, ten minutes of a simulated dock on a bad line, ten of the closed loop; SOAK_SECONDS=20 for a short run
	@CHROMADOCK_STREAM_S=$(or $(SOAK_SECONDS),60) $(VENV)/python -m pytest -q -s tests/host/test_streams.py -k behind
	@CHROMADOCK_KILLS=20 $(VENV)/python -m pytest -q tests/host/recording/test_disk.py -k kill
	@$(VENV)/python tools/soak.py $(if $(SOAK_SECONDS),--seconds=$(SOAK_SECONDS))
	@$(VENV)/python tools/closed_loop.py $(if $(SOAK_SECONDS),--seconds=$(SOAK_SECONDS))

image: setup ## The BlueOS extension's commands in fresh environments, and its wheels for arm64; needs the network
	@$(VENV)/python tools/image.py

night: setup ## Nights of twelve hours of a dock that sees its own lamps, in fast time; HOURS=1 for a short run
	@$(VENV)/python tools/night.py $(if $(HOURS),--hours=$(HOURS))

setup-bench:
	@$(PYTHON) tools/setup bench

bench: setup-bench ## Measure against the budgets: out/bench.json
	@$(VENV)/python tools/bench.py

fuzz: setup ## Five minutes of libFuzzer on the link's receiver
	@$(VENV)/python tools/fuzz.py --seconds 300

lint: setup ## Run the checks of the source code only
	@$(VENV)/python tools/lint.py

format: setup ## Format the Python and C sources
	@$(VENV)/python tools/format.py

generate: setup-demo ## Write tables and golden vectors from shared/method.toml, and the page of the vehicle's keys
	@$(VENV)/python shared/generate.py
	@$(VENV)/python tools/configuration.py

contrast: setup-demo ## Choose the mapping contrast anew from simulated waters, then the same
	@$(VENV)/python shared/contrast.py
	@$(VENV)/python shared/generate.py

clean: ## Remove everything that was installed, built or written here
	rm -rf .venv build out .pio .pytest_cache .mypy_cache .ruff_cache .hypothesis
	rm -rf host/build host/*.egg-info host/chromadock/dialect.py host/chromadock/_native.*
	rm -rf firmware/bindings/build firmware/bindings/*.egg-info
