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
# A part of the unit tests on each processor.
IN_PARTS = seq 0 $$(($$(nproc) - 1)) | GTEST_TOTAL_SHARDS=$$(nproc) xargs -P 0 -I{} \
           env GTEST_SHARD_INDEX={} $(1)/unit-tests --gtest_brief=1
ASAN_CLI := $(addprefix tests/cli/,broken.bats options.bats maps.bats matrix.bats files accidents/upstream.bats)
TSAN_CLI := $(addprefix tests/cli/,train.bats eval.bats finetune.bats)
# Tests send SIGSEGV and the like themselves.
asan: export ASAN_OPTIONS := handle_segv=0:handle_sigbus=0:handle_sigfpe=0
asan:
	$(MAKE) B=build-asan CXXFLAGS='$(ASAN_FLAGS)' all build-asan/unit-tests
	$(call IN_PARTS,build-asan)
	SYNPO_BUILD='$(CURDIR)/build-asan' bats --recursive $(ASAN_CLI)
	ACCIDENTS=full SYNPO_BUILD='$(CURDIR)/build-asan' bats tests/cli/accidents/numbers.bats
	@echo "asan: unit tests, $(ASAN_CLI) and the ends of all options passed"

tsan:
	$(MAKE) B=build-tsan DRAW=no CXXFLAGS='$(TSAN_FLAGS)' all build-tsan/unit-tests
	$(call IN_PARTS,build-tsan)
	SYNPO_BUILD='$(CURDIR)/build-tsan' bats $(TSAN_CLI)
	@echo "tsan: unit tests and $(TSAN_CLI) passed"
