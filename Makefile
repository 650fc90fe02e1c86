# synpo: make help says what there is to make. make V=1 shows the commands.

VERSION  := 0.2.0
CXX      ?= g++
PREFIX   ?= /usr/local
B        := build

# What installs and compilers say goes to stderr where something else is asked for.
ASIDE := $(if $(filter bench deps deps-torch,$(MAKECMDGOALS)),>&2)

# Builds on all processors. A make that another one starts has what that one has.
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(shell nproc)
endif

# Goals that do more than build come one after the other, each with a make of its own: first the packages, then what
# needs them; first clean, then all.
ifneq ($(and $(word 2,$(MAKECMDGOALS)),$(filter-out all lib torch completions $(B)/%,$(MAKECMDGOALS))),)
.NOTPARALLEL:
$(MAKECMDGOALS): FORCE
	@$(MAKE) --no-print-directory ASIDE='$(ASIDE)' $@
FORCE:
else

# What fails leaves no file that looks as if it were made.
.DELETE_ON_ERROR:

# Programs, tables, pictures and tests take longer to compile than to run. CXXFLAGS of the caller come last and win.
QUICK    := tools lib/draw lib/stats/matrix lib/stats/report tests/unit
OPTIMISE  = $(if $(filter $(QUICK:%=$(B)/%/%),$@),-O1,-O3)
# Clang warns of the GNU library's own std::stable_sort.
OF_CLANG := -Wno-unknown-warning-option -Wno-deprecated-declarations
ALL_CXXFLAGS = -std=c++20 -Wall -Wextra -Wno-maybe-uninitialized -Wno-restrict -fno-math-errno -ffp-contract=fast \
               $(if $(findstring clang,$(CXX)),$(OF_CLANG)) \
               -pthread -MMD -MP -Ilib -Itools $(INCLUDES) $(if $(KIT),-isystem $(KIT)) \
               -isystem $(or $(KIT),/usr/include)/eigen3 $(OPTIMISE) $(CXXFLAGS)
OPENCV_CFLAGS := -isystem /usr/include/opencv4
CAIRO_CFLAGS  := -isystem /usr/include/cairo -isystem /usr/include/freetype2 -isystem /usr/include/harfbuzz
DRAW_LIBS     = $(if $(filter no,$(DRAW)),,$(ALL_DRAW_LIBS))
ALL_DRAW_LIBS := -lopencv_dnn -lopencv_videoio -lopencv_imgcodecs -lopencv_imgproc -lopencv_core \
                 -lcairo -lharfbuzz -lfreetype -lz -lgif

TOOLS    := synpo-gen-expert synpo-train synpo-finetune synpo-eval synpo-matrix synpo-render
# DRAW=no leaves out pictures, and with them OpenCV, cairo and giflib; synpo-render
# then says that they are missing.
LIB_SRC  := $(sort $(shell find lib -name '*.cc' -not -path 'lib/torch/*' \
            $(if $(filter no,$(DRAW)),-not '(' -path 'lib/draw/*/*' -not -path 'lib/draw/terminal/*' ')')))
# The kernels are compiled once for each kind of processor; the program picks when it starts (lib/kernel).
# The machine that the compiler is for; this one while no compiler is installed.
MACHINE  := $(firstword $(subst -, ,$(shell $(CXX) -dumpmachine 2>/dev/null || uname -m)))
TARGETS  := plain $(if $(filter x86_64,$(MACHINE)),avx2 avx512 bf16 amx)
TARGET_avx2   := -mavx2 -mfma
TARGET_avx512 := $(TARGET_avx2) -mavx512f -mavx512bw -mavx512dq -mavx512vl
TARGET_bf16   := $(TARGET_avx512) -mavx512bf16
TARGET_amx    := $(TARGET_avx512) -mamx-tile -mamx-bf16 -Wno-uninitialized  # GCC 12 warns of its own header
# Which products and sums become one instruction, and with it the last bit, depends on the optimiser: always the same
# level, and no tuning that leaves some sums of up to so many bits unfused, as GCC 14 has.
FUSED_ALL := --param=avoid-fma-max-bits=0
KERNEL_FLAGS = -O3 -Wno-psabi $(if $(findstring clang,$(CXX)),,$(FUSED_ALL)) $(TARGET_$*)
KERNEL_OBJ := $(TARGETS:%=$(B)/lib/kernel/target_%.o)
LIB_OBJ  := $(filter-out %/target.o,$(LIB_SRC:%.cc=$(B)/%.o)) $(KERNEL_OBJ) $(B)/builtin_maps.o $(B)/version.o
TOOL_SRC := $(sort $(shell find tools -name '*.cc'))
TEST_SRC := $(sort $(shell find tests/unit -name '*.cc' $(if $(filter no,$(DRAW)),-not -path 'tests/unit/draw/*')))
TEST_OBJ := $(TEST_SRC:%.cc=$(B)/%.o)
MAPS     := $(sort $(wildcard lib/world/grid/maps/map*.txt))

PACKAGES := g++ make libeigen3-dev libopencv-dev libcairo2-dev libharfbuzz-dev libgif-dev nlohmann-json3-dev \
            fonts-dejavu-core libgtest-dev bats jq man-db python3-numpy poppler-utils

DEB_PACKAGES := debhelper lintian dpkg-dev fakeroot pkg-config

# What make install puts under PREFIX and make uninstall takes away: SOURCE:PLACE. Of the libraries those that were
# built.
LIBDIR    ?= lib
PYTHONDIR ?= share/synpo/python
HEADERS   := $(sort $(shell find lib -name '*.h' -not -path 'lib/torch/*'))
# Debian's zsh looks for its own packages' completions elsewhere than for others.
ZSH_DIR    = share/zsh/$(if $(filter /usr,$(PREFIX)),vendor-completions,site-functions)
COMPLETIONS := $(TOOLS:%=$(B)/completions/bash/%) $(TOOLS:%=$(B)/completions/zsh/_%) \
             $(TOOLS:%=$(B)/completions/fish/%.fish)
INSTALLED  = $(foreach tool,$(TOOLS),$(B)/$(tool):bin/$(tool)) \
             $(B)/libsynpo.a:$(LIBDIR)/libsynpo.a $(B)/synpo.pc:$(LIBDIR)/pkgconfig/synpo.pc \
             $(foreach tool,$(TOOLS),$(B)/completions/bash/$(tool):share/bash-completion/completions/$(tool) \
                 $(B)/completions/zsh/_$(tool):$(ZSH_DIR)/_$(tool) \
                 $(B)/completions/fish/$(tool).fish:share/fish/vendor_completions.d/$(tool).fish) \
             $(foreach header,$(HEADERS),$(header):$(header:lib/%=include/synpo/%)) \
             $(B)/libsynpo_torch.so:lib/synpo/libsynpo_torch.so \
             $(foreach module,$(wildcard python/*.py),$(module):$(PYTHONDIR)/$(notdir $(module))) \
             $(foreach page,$(wildcard man/*),$(page):share/man/man$(subst .,,$(suffix $(page)))/$(notdir $(page)))

# LibTorch on Debian takes any BLAS; with the reference one it crawls.
TORCH_PACKAGES := libtorch-dev libopenblas0-openmp

# The plug-in of LibTorch, for --device: against Debian's LibTorch, or the one in the folder TORCH. That of PyTorch is
#   python3 -c 'import torch, os; print(os.path.dirname(torch.__file__))'
TORCH       :=
TORCH_DIR   := $(or $(TORCH),/usr)
TORCH_LIB   := $(or $(TORCH:%=%/lib),/usr/lib/$(shell $(CXX) -dumpmachine 2>/dev/null))
TORCH_CUDA  := $(wildcard $(TORCH_LIB)/libtorch_cuda.so)
CUDA_HOME   ?= /usr/local/cuda
TORCH_STD   ?= c++17
TORCH_SRC   := $(sort $(wildcard lib/torch/*.cc))
TORCH_OBJ   := $(TORCH_SRC:%.cc=$(B)/%.o)
TORCH_CFLAGS = -std=$(TORCH_STD) -Wall -Wextra -O1 -fPIC -fvisibility=hidden -MMD -MP -Ilib \
               $(if $(TORCH),-isystem $(TORCH)/include) -isystem $(TORCH_DIR)/include/torch/csrc/api/include \
               $(if $(TORCH_CUDA),-DSYNPO_TORCH_CUDA -isystem $(CUDA_HOME)/include) \
               $(if $(shell grep -l __cxx11 $(TORCH_LIB)/libc10.so 2>/dev/null),,-D_GLIBCXX_USE_CXX11_ABI=0)
TORCH_LIBS   = -L$(TORCH_LIB) $(if $(TORCH),-Wl$(,)-rpath$(,)$(TORCH_LIB)) \
               -Wl,--no-as-needed -ltorch -ltorch_cpu -lc10 $(if $(TORCH_CUDA),-ltorch_cuda -lc10_cuda)
, := ,

# ccache compiles nothing twice, and does without precompiled headers.
ifeq ($(findstring ccache,$(CXX)),)
STD     := $(B)/std.h.gch/O1.gch $(B)/std.h.gch/O3.gch
USE_STD := -include $(B)/std.h
endif

ifeq ($(V),1)
Q   :=
say :=
else
Q   := @
say = @printf '%-4s %s\n' '$(1)' '$(2)' $(ASIDE)
endif

.PHONY: all completions lib torch check test lint bench demo gallery deps deps-torch deps-deb deb install uninstall \
    clean check-torch gpu-kit dist help
all: $(B)/told
# So that make -q all says whether anything is to be built.
$(B)/told: $(TOOLS:%=$(B)/%)
	@echo "The programs are in $(B)/: $(TOOLS)" $(ASIDE)
	@touch $@
lib: $(B)/libsynpo.a
torch: $(B)/libsynpo_torch.so
	@echo "The plug-in of LibTorch is $<: --device torch-cpu$(if $(TORCH_CUDA), or cuda) uses it" $(ASIDE)

# Written anew, and with them whatever depends on them, where the flags are other ones than those of the last build, or
# what is put together. The flags unexpanded: some depend on what is compiled.
FLAGS := $(foreach name,CXX CXXFLAGS KIT ALL_CXXFLAGS OF_CLANG QUICK OPTIMISE OPENCV_CFLAGS CAIRO_CFLAGS KERNEL_FLAGS \
           FUSED_ALL $(TARGETS:%=TARGET_%),$(value $(name)))
PARTS := $(LIB_OBJ) $(DRAW_LIBS) $(GTEST) $(LDFLAGS)
ifneq ($(FLAGS),$(file <$(B)/flags))
$(B)/flags: FORCE
endif
ifneq ($(PARTS),$(file <$(B)/parts))
$(B)/parts: FORCE
endif
$(B)/flags: export TEXT := $(FLAGS)
$(B)/parts: export TEXT := $(PARTS)
$(B)/flags $(B)/parts:
	@mkdir -p $(@D)
	@printf '%s\n' "$$TEXT" > $@

$(B)/libsynpo.a: $(LIB_OBJ) $(B)/parts
	$(call say,AR,$@)
	$(Q)rm -f $@ && ar rcs $@ $(LIB_OBJ)

# What is linked, of what a program depends on.
OBJECTS = $(filter %.o %.a,$^)

# Every tool is one file of its name; those of several commands have a folder of them.
define TOOL_RULE
$(B)/$(1): $(patsubst %.cc,$(B)/%.o,$(if $(filter synpo-render-no,$(1)-$(DRAW)),tools/without_drawing/$(1).cc, \
           tools/$(1).cc $(wildcard tools/$(1:synpo-%=%)/*.cc))) $(B)/libsynpo.a $(B)/parts
	$$(call say,LINK,$$@)
	$$(Q)$$(CXX) $$(ALL_CXXFLAGS) -o $$@ $$(filter %.o,$$^) $(B)/libsynpo.a $$(LDFLAGS) \
	    $(if $(filter synpo-render,$(1)),$$(DRAW_LIBS))
endef
$(foreach tool,$(TOOLS),$(eval $(call TOOL_RULE,$(tool))))

# A file that is made every time and stays what it was where nothing has changed.
if_other = if cmp -s $@.part $@; then rm $@.part; else mv $@.part $@; fi

# What the plug-in was built against, and how, counts as one of its sources.
$(B)/lib/torch/from: FORCE
	@mkdir -p $(@D)
	@echo '$(CXX) $(TORCH_CFLAGS) $(TORCH_LIBS)' > $@.part
	@$(if_other)
.PHONY: FORCE
$(TORCH_OBJ): $(B)/%.o: %.cc $(B)/lib/torch/from
	@mkdir -p $(@D)
	$(call say,CXX,$<)
	$(Q)$(CXX) $(TORCH_CFLAGS) -c -o $@ $<
$(B)/libsynpo_torch.so: $(TORCH_OBJ)
	$(call say,LINK,$@)
	$(Q)$(CXX) -shared -o $@ $^ $(TORCH_LIBS)

$(B)/synpo-bench: $(B)/tests/bench/synpo-bench.o $(B)/libsynpo.a $(B)/parts
	$(call say,LINK,$@)
	$(Q)$(CXX) $(ALL_CXXFLAGS) -o $@ $(OBJECTS) $(LDFLAGS)

# The engines' tests alone, with GoogleTest's sources where it is not installed.
$(B)/engine-tests: $(filter $(B)/tests/unit/engine/%,$(TEST_OBJ)) $(if $(KIT),$(B)/gtest.o) $(B)/libsynpo.a $(B)/parts
	$(call say,LINK,$@)
	$(Q)$(CXX) $(ALL_CXXFLAGS) -o $@ $(OBJECTS) $(LDFLAGS) $(if $(KIT),,-lgtest -lgtest_main)
$(B)/gtest.o: $(B)/flags
	$(call say,CXX,$(KIT)/gtest)
	$(Q)cat $(KIT)/gtest/src/gtest-all.cc $(KIT)/gtest/src/gtest_main.cc | \
	    $(CXX) -std=c++17 -O1 -I$(KIT) -I$(KIT)/gtest -x c++ -c -o $@ -

$(B)/unit-tests: $(TEST_OBJ) $(B)/libsynpo.a $(B)/parts
	$(call say,LINK,$@)
	$(Q)$(CXX) $(ALL_CXXFLAGS) -o $@ $(OBJECTS) $(LDFLAGS) $(or $(GTEST),-lgtest -lgtest_main) $(DRAW_LIBS)

$(TEST_OBJ): INCLUDES += -Itests/unit

# Eigen, the yardstick there, knows no dispatch at run time.
$(B)/tests/bench/synpo-bench.o: OPTIMISE = -O3 -march=native

# Only these see cairo, and OpenCV.
$(B)/lib/draw/canvas/%.o $(B)/tests/unit/draw/%.o: INCLUDES += $(CAIRO_CFLAGS)
$(B)/lib/draw/video/%.o $(B)/lib/draw/vision/%.o: INCLUDES += $(OPENCV_CFLAGS)

$(KERNEL_OBJ): $(B)/lib/kernel/target_%.o: lib/kernel/target.cc $(B)/flags
	@mkdir -p $(@D)
	$(call say,CXX,$< for $*)
	$(Q)$(CXX) $(ALL_CXXFLAGS) $(KERNEL_FLAGS) -DSYNPO_TARGET=$* -c -o $@ $<

$(B)/%.o: %.cc $(B)/flags | $(STD)
	@mkdir -p $(@D)
	$(call say,CXX,$<)
	$(Q)$(CXX) $(ALL_CXXFLAGS) $(USE_STD) -c -o $@ $<

# A third of the time of most files is that of reading these. Not for the kernels, which share no code with the rest.
$(B)/std.h:
	@mkdir -p $(@D)
	@printf '#include <%s>\n' algorithm array cmath cstdint cstring functional map memory optional set sstream string \
	    unordered_map unordered_set vector > $@
$(STD): $(B)/std.h.gch/%.gch: $(B)/std.h $(B)/flags
	@mkdir -p $(@D)
	$(call say,CXX,$< -$*)
	$(Q)$(CXX) $(ALL_CXXFLAGS) -x c++-header -o $@ $<
$(B)/std.h.gch/O1.gch: OPTIMISE = -O1

$(B)/builtin_maps.cc: $(MAPS) Makefile
	@mkdir -p $(@D)
	@set -e; { echo '#include "world/grid/builtin_maps.h"'; echo 'namespace synpo {'; \
	   echo 'const std::vector<BuiltinMap> kBuiltinMaps = {'; \
	   for map in $(MAPS); do printf '{"%s", R"(' "$$(basename $$map .txt)"; cat $$map; echo ')"},'; done; \
	   echo '};'; echo '}'; } > $@
# Written again, and with it compiled, where the commit is another one than that of the last build. make COMMIT=abc1234
# says it where there is no git.
ifneq ($(origin COMMIT),command line)
COMMIT := $(shell scripts/commit)
endif
NAMES := const char kVersion[] = "$(VERSION)", kCommit[] = "$(COMMIT)";
ifeq ($(findstring $(NAMES),$(file <$(B)/version.cc)),)
$(B)/version.cc: FORCE
endif
$(B)/version.cc: Makefile
	@mkdir -p $(@D)
	@printf '%s\n' '#include "base/cli/version.h"' 'namespace synpo {' '$(NAMES)' '}' > $@
$(B)/builtin_maps.o $(B)/version.o: %.o: %.cc $(B)/flags
	$(call say,CXX,$<)
	$(Q)$(CXX) $(ALL_CXXFLAGS) -c -o $@ $<

check test: all $(B)/unit-tests
	@scripts/check $(B)

include tests/fuzz/fuzz.mk tests/checks.mk

lint:
	scripts/lint

# The two engines beside each other, with a table of the worst errors. AMX rounds the CPU's products to less than
# float32.
check-torch: torch $(B)/engine-tests
	$(Q)! grep -q amx_tile /proc/cpuinfo || export SYNPO_KERNELS=avx512; SYNPO_TORCH= $(B)/engine-tests --gtest_brief=1

bench: all $(B)/synpo-bench
	@scripts/bench $(B)

gallery: all
	scripts/gallery $(B) $(if $(CHECKPOINT),'$(CHECKPOINT)')

demo: all
	@scripts/demo $(B)

deps:
	@scripts/deps $(PACKAGES)

# What scripts/check-gpu needs on a machine that has nothing but a compiler, make and PyTorch.
gpu-kit:
	scripts/gpu-kit

deps-torch:
	@scripts/deps $(TORCH_PACKAGES)

# Completions of the shells, from each program's table of options.
completions: $(COMPLETIONS)
complete = $(Q)mkdir -p $(@D) && scripts/completions $(1) $< >$@.part && mv $@.part $@
$(B)/completions/bash/%: $(B)/% scripts/completions
	$(call complete,bash)
$(B)/completions/zsh/_%: $(B)/% scripts/completions
	$(call complete,zsh)
$(B)/completions/fish/%.fish: $(B)/% scripts/completions
	$(call complete,fish)

# For pkg-config. The library is static: what draws needs pkg-config --static.
$(B)/synpo.pc: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' 'prefix=$(PREFIX)' 'includedir=$${prefix}/include/synpo' 'libdir=$${prefix}/$(LIBDIR)' '' \
	    'Name: synpo' 'Description: policies that transfer across environments and tasks' 'Version: $(VERSION)' \
	    'Cflags: -I$${includedir}' 'Libs: -L$${libdir} -lsynpo -pthread' 'Libs.private: $(DRAW_LIBS)' > $@.part
	@$(if_other)

install: all completions $(B)/synpo.pc
	$(Q)set -e; for file in $(INSTALLED); do \
	    from=$${file%%:*} to=$${file#*:} mode=644; \
	    case $$to in bin/*) mode=755 ;; *.a | *.so) [ -e "$$from" ] || continue ;; esac; \
	    install -D -m $$mode "$$from" "$(DESTDIR)$(PREFIX)/$$to"; done
	@echo "The programs are in $(DESTDIR)$(PREFIX)/bin, their pages in $(DESTDIR)$(PREFIX)/share/man" $(ASIDE)

# Folders go too where nothing else is in them.
uninstall:
	$(Q)for file in $(INSTALLED); do rm -f "$(DESTDIR)$(PREFIX)/$${file#*:}"; done
	$(Q)for folder in include/synpo lib/synpo share/synpo; do folder="$(DESTDIR)$(PREFIX)/$$folder"; \
	    [ ! -d "$$folder" ] || find "$$folder" -depth -type d -empty -delete; done

# scripts/check-deb looks at them, installs them and takes them away again.
deb: all
	@scripts/deb $(B) $(VERSION)
deps-deb:
	@scripts/deps $(DEB_PACKAGES)

# The sources of the commit, to the same bytes whoever makes it.
dist:
	@mkdir -p $(B)
	@git archive --format=tar --prefix=synpo-$(VERSION)/ HEAD >$(B)/dist.tar
	@gzip -9 -n <$(B)/dist.tar >$(B)/synpo-$(VERSION).tar.gz && rm $(B)/dist.tar
	@git diff --quiet HEAD || echo 'dist: changes since the last commit are not in it' >&2
	@echo $(B)/synpo-$(VERSION).tar.gz

help:
	@printf '  make %-11s %s\n' \
	    '' 'the programs, in $(B)/' \
	    deps 'install the Debian packages that are needed, as root or with sudo' \
	    demo 'a small training and its pictures, in $(B)/demo' \
	    'check, test' 'all tests' \
	    lint 'look at the sources without running them' \
	    install 'programs, pages, completions, library and synpo.py, under PREFIX=/usr/local' \
	    uninstall 'take them away again' \
	    lib 'the library alone, $(B)/libsynpo.a' \
	    deps-torch 'install what torch needs' \
	    torch 'the plug-in of LibTorch, for --device; TORCH=DIR for that of a PyTorch' \
	    check-torch 'compare the two engines' \
	    bench 'rates, as a table' \
	    gallery 'draw lab/gallery again' \
	    gpu-kit 'pack what scripts/check-gpu compiles with' \
	    dist 'a tarball of the sources' \
	    deps-deb 'install what deb needs' \
	    deb 'Debian packages, in $(B)/deb' \
	    completions 'of bash, zsh and fish, in $(B)/completions' \
	    fuzz 'feed every reader what it does not expect (tests/fuzz)' \
	    'asan, tsan' 'the tests under sanitizers, in build-asan and build-tsan' \
	    accidents 'many kills, and a stream of 5 GB (tests/cli/accidents)' \
	    long-run 'two hours of training under a limit of memory (tests/long-run)' \
	    clean 'remove $(B)/'
	@echo; echo 'V=1 shows the commands; CXXFLAGS, DESTDIR, PREFIX and B=DIR (for $(B)/) are kept.'

clean:
	rm -rf $(B)

-include $(shell find $(B) -type f -name '*.d' 2>/dev/null)

endif # of goals one after the other
