# What takes longer than make check: accidents by the hundred, hours of training, the suite under the sanitizers.
.PHONY: accidents long-run

# KILLS of each of four commands, streams of 5 GB, so many evaluations.
KILLS ?= 50
EVALUATIONS ?= 10000
accidents: all
	KILLS=$(KILLS) EVALUATIONS=$(EVALUATIONS) ACCIDENTS=full SYNPO_BUILD='$(abspath $(B))' bats tests/cli/accidents

# Seconds of training under a limit of memory, whose log is build/long-run/memory.tsv.
LONG ?= 7200
long-run: all
	tests/long-run $(B) $(LONG) $(B)/long-run

# The suite under the sanitizers, in build-asan (addresses and undefined behaviour) and build-tsan (threads). Under them
# the unit tests run all; of the command line, with the first what reads, what options say, and what happens to files,
# with the other what threads do. Pictures are drawn by one thread: build-tsan has none. A process is ten times as slow.
.PHONY: asan tsan
SANITIZED := -O1 -g1 -fno-omit-frame-pointer
# Tests are compiled quickly: most of them are run once.
OF_TESTS = $$(if $$(filter $$(B)/tests/%,$$@),-O0 $(1))
ASAN_FLAGS := $(SANITIZED) -fsanitize=address,undefined,float-cast-overflow \
              -fno-sanitize-recover=undefined,float-cast-overflow \
              $(call OF_TESTS,-fno-sanitize=undefined -fno-sanitize=float-cast-overflow)
TSAN_FLAGS := $(SANITIZED) -fsanitize=thread $(call OF_TESTS)
ASAN_CLI := $(addprefix tests/cli/,broken.bats options.bats maps.bats matrix.bats files \
            $(addprefix accidents/,numbers.bats upstream.bats))
TSAN_CLI := $(addprefix tests/cli/,train.bats eval.bats finetune.bats)
# Tests send SIGSEGV and the like themselves.
asan: export ASAN_OPTIONS := handle_segv=0:handle_sigbus=0:handle_sigfpe=0
# The ends of all options.
asan: export ACCIDENTS := full
asan:
	$(MAKE) B=build-asan CXXFLAGS='$(ASAN_FLAGS)' all build-asan/unit-tests
	CHECK_CLI='$(ASAN_CLI)' scripts/check build-asan

tsan:
	$(MAKE) B=build-tsan DRAW=no CXXFLAGS='$(TSAN_FLAGS)' all build-tsan/unit-tests
	CHECK_CLI='$(TSAN_CLI)' scripts/check build-tsan
