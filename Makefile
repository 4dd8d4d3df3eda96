# The front door. Every target first installs what it needs and no more (tools/setup), so each works on
# a fresh machine and is quick the second time. The build itself is CMake's: see CMakePresets.json.
JOBS ?= $(shell nproc)
FUZZ_SECONDS ?= 600
PYTHON := .venv/bin/python

.PHONY: help run host firmware tools test bench demo pictures fuzz reference format clean
.DEFAULT_GOAL := help

help: ## say what there is
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 16

run: host ## the BASIC prompt in this terminal; no board needed
	@build/host/stepmite

host: ## build/host/stepmite, the firmware as a program
	@tools/setup host
	@$(call build,host,,stepmite)

firmware: ## build/pico/stepmite-pico.uf2 and build/pico2/stepmite-pico2.uf2
	@tools/setup firmware
	@$(call build,pico,,stepmite-pico)
	@$(call build,pico2,,stepmite-pico2)

tools: ## .venv/bin/stepmite, the PC tools: stream, console, plot
	@tools/setup tools
	@echo "the PC tools are ready: .venv/bin/stepmite --help"

test: ## every test; under 15 minutes on two cores
	@tools/setup test
	@$(foreach preset,host asan pico pico2,$(call build,$(preset),-DSTEPMITE_TESTS=ON,all) &&) true
	@$(PYTHON) -m pytest -q -n $(JOBS) --timeout 600 tests

bench: ## cycles in the emulator, motion times; writes docs/performance.md
	@tools/setup bench
	@$(call build,host,,stepmite)
	@$(call build,pico,,stepmite-pico)
	@$(PYTHON) tests/bench/bench_tick.py --write docs/performance.md

demo: ## the firmware in the emulator cuts a real part; draws build/demo/demo.png
	@tools/setup demo
	@$(call build,pico,,stepmite-pico)
	@$(PYTHON) -m stepmite.demo

pictures: ## docs/images/motion-*.png, speed to jerk from the step edges of the host program
	@tools/setup tools
	@$(call build,host,,stepmite)
	@$(PYTHON) tests/bench/pictures.py docs/images

fuzz: ## feed garbage to the prompt and the G-code reader for FUZZ_SECONDS (600)
	@tools/setup fuzz
	@$(call build,asan,-DSTEPMITE_TESTS=ON,stepmite_fuzz)
	@build/asan/stepmite_fuzz --seconds $(FUZZ_SECONDS)

reference: ## docs/reference.md, docs/tmc22xx-registers.md from the firmware's tables
	@tools/setup host
	@$(call build,host,,stepmite_reference stepmite_register_page)
	@build/host/tools/reference/stepmite_reference >docs/reference.md
	@build/host/tools/reference/stepmite_register_page >docs/tmc22xx-registers.md

format: ## put our C and Python files into the common form
	@tools/setup format
	@tools/format

clean: ## remove everything built
	rm -rf build

# $(call build,PRESET,OPTIONS,TARGET): configures quietly and builds.
build = mkdir -p build && { cmake --preset $(1) $(2) >build/$(1).log 2>&1 || { cat build/$(1).log; false; }; } \
	&& cmake --build --preset $(1) -j $(JOBS) --target $(3)
