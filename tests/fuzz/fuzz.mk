# Fuzzing, with clang: the library without pictures is compiled into build-fuzz, checked for addresses and undefined
# behaviour, and a program for each reader is linked with it. FUZZ_TIME is that of a reader.
FUZZ_CXX  ?= clang++
FUZZ_TIME ?= 60
FUZZ_SANITIZE := -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all
FUZZ_TARGETS  := $(patsubst tests/fuzz/%.cc,%,$(filter-out %/fuzz.cc,$(wildcard tests/fuzz/*.cc)))

.PHONY: fuzz fuzz-targets deps-fuzz
deps-fuzz:
	scripts/deps clang libclang-rt-14-dev
fuzz: all
	$(MAKE) B=build-fuzz DRAW=no CXX='$(FUZZ_CXX)' fuzz-targets \
	    CXXFLAGS='-O1 -g1 -fno-omit-frame-pointer -fsanitize=fuzzer-no-link $(FUZZ_SANITIZE)'
	tests/fuzz/run build-fuzz $(B) $(FUZZ_TIME)

fuzz-targets: $(FUZZ_TARGETS:%=$(B)/fuzz/%)
$(B)/fuzz/%: $(B)/tests/fuzz/%.o $(B)/tests/fuzz/fuzz.o $(B)/lib/draw/plot/curves_style.o $(B)/tools/render/files.o \
    $(B)/libsynpo.a
	@mkdir -p $(@D)
	$(call say,LINK,$@)
	$(Q)$(CXX) -pthread -fsanitize=fuzzer $(FUZZ_SANITIZE) -o $@ $^ $(LDFLAGS)
.SECONDARY: $(FUZZ_TARGETS:%=$(B)/tests/fuzz/%.o)
