# What takes longer than make check: the suite under the sanitizers, and accidents by the hundred.
.PHONY: accidents

# KILLS of each of four commands, and streams of 5 GB.
KILLS ?= 50
accidents: all
	KILLS=$(KILLS) ACCIDENTS=full SYNPO_BUILD='$(abspath $(B))' bats tests/cli/accidents
