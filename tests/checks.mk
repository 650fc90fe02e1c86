# What takes longer than make check: the suite under the sanitizers, and accidents by the hundred.
.PHONY: accidents

# KILLS of each of four commands, and streams of 5 GB.
KILLS ?= 50
accidents: all
	KILLS=$(KILLS) ACCIDENTS=full SYNPO_BUILD='$(abspath $(B))' bats tests/cli/accidents

# The suite under the sanitizers, in build-asan (addresses and undefined behaviour) and build-tsan (threads). Under them
# the unit tests run all, and of the command line what reads, what options say, and what happens to files.
.PHONY: asan tsan
SANITIZED := -O1 -g1 -fno-omit-frame-pointer -fno-sanitize-recover=all
SANITIZED_CLI := $(addprefix tests/cli/,broken.bats options.bats maps.bats matrix.bats files accidents/upstream.bats \
                 accidents/numbers.bats)
asan:
	$(MAKE) B=build-asan CXXFLAGS='$(SANITIZED) -fsanitize=address,undefined,float-cast-overflow' \
	    all build-asan/unit-tests
	build-asan/unit-tests --gtest_brief=1
	SYNPO_BUILD='$(CURDIR)/build-asan' bats --recursive $(SANITIZED_CLI)
	@echo "asan: unit tests and $(SANITIZED_CLI) passed"

tsan:
	$(MAKE) B=build-tsan CXXFLAGS='$(SANITIZED) -fsanitize=thread' all build-tsan/unit-tests
	TSAN_OPTIONS='suppressions=$(CURDIR)/tests/tsan.supp' build-tsan/unit-tests --gtest_brief=1
	@echo "tsan: unit tests passed"
