# hoodoo: build, demo, test. `make help` lists the targets.

PACKAGES = build-essential pkg-config glslang-dev spirv-tools libvulkan-dev mesa-vulkan-drivers \
	libopenvdb-dev libboost-dev libassimp-dev libmuparser-dev libopenexr-dev libopenimageio-dev openimageio-tools libtiff-dev libjpeg-dev libfyaml-dev libzstd-dev zstd \
	libseccomp-dev libmicrohttpd-dev libpng-dev libxxhash-dev povray povray-includes ffmpeg fonts-dejavu-core
TEST_PACKAGES = procps libcmocka-dev vulkan-validationlayers libopenvdb-tools openexr python3-openvdb python3-openimageio python3-numpy python3-scipy \
	libcgal-dev libeigen3-dev gdal-bin
LONG_PACKAGES = libcgal-demo debootstrap bindfs slurmctld slurmd slurm-client munge
PEER_PACKAGES = lintian blender chromium slurmctld slurmd slurm-client munge python3-venv bindfs
BENCH_PACKAGES = python3-petsc4py-real python3-venv
BENCH_WHEELS = taichi==1.7.4 fastscapelib==0.3.0 pyamg==5.4.1 'numpy<2'
PEER_WHEELS = usd-core==26.11 numpy==2.2.6 trimesh==4.6.8 plyfile==1.1 check-jsonschema==0.39.0
DEV_PACKAGES = clang clang-format libclang-rt-14-dev libomp-dev codespell
TIDY_PACKAGES = clang-tidy cppcheck

# As many jobs as cores, unless -j is given. A recursive make shares the jobs of the first one.
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += --jobs=$(shell nproc)
endif

VERSION = 0.2.0
BUNDLE = hoodoo-$(VERSION)-linux-x86_64
BUILD = build
SHARE = $(BUILD)
CC = gcc
CXX = g++
OPT = -O2 -g1
WARN = -Wall -Wextra -Wpedantic -Wshadow -Wconversion
SANITIZE =
COMMIT = $(shell git rev-parse --short=12 HEAD 2>/dev/null || echo unknown)

CPPFLAGS = -D_GNU_SOURCE -Isrc -Ishaders -I. -I$(SHARE)/gen
CFLAGS = -std=c11 $(OPT) $(PIC) $(WARN) -fno-math-errno -ffp-contract=off -fopenmp $(SANITIZE)
CXXFLAGS = -std=c++17 $(OPT) $(PIC) -Wall -Wextra -isystem /usr/include/OpenEXR -isystem /usr/include/Imath
LDLIBS = -lvulkan -lOpenEXRCore-3_1 -lpng16 -lfyaml -lzstd -lxxhash -lm -lpthread
VDB_LIBS = -lopenvdb -ltbb -lImath-3_1 -lxxhash -lstdc++
EXR_FLAGS = -isystem /usr/include/OpenEXR -isystem /usr/include/Imath

Q = $(if $(V),,@)
SRC = $(shell find src farm render -name '*.c' -not -path 'farm/bundle/*')
SHIM = $(shell find src farm render -name '*_shim.cpp' -not -path 'farm/bundle/*')
SHADER = $(shell find shaders -name '*.comp.glsl')
KERNELS = $(sort $(patsubst shaders/%/,%,$(dir $(SHADER)))) kernels
SHIM_OBJ = $(SHIM:%.cpp=$(SHARE)/%.o)
LIB_OBJ = $(patsubst %.c,$(BUILD)/%.o,$(filter-out $(wildcard src/*.c),$(SRC))) $(SHIM_OBJ) \
	$(KERNELS:%=$(BUILD)/gen/gpu/%.o) $(BUILD)/gen/render/scene_parts.o $(BUILD)/gen/cli/examples.o
TEST_SRC = $(wildcard tests/*/test_*.c)
TEST_BIN = $(TEST_SRC:%.c=$(BUILD)/%)
BENCH_BIN = $(patsubst %.c,$(BUILD)/%,$(wildcard tests/bench/*.c)) $(BUILD)/tests/bench/surface
TEST_HELP = $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/ref/*.c))
# Without this, make would delete them as intermediate files after each build, and link every test again.
.SECONDARY: $(TEST_HELP)
KEEP = $(if $(SANITIZE),$(BUILD)/tests/sanitized/keep_libraries.o)

## all: build build/hoodoo (installs what is missing when root)
all: $(BUILD)/hoodoo

## deps: install the Debian packages this needs, or print the one command that does
deps: $(BUILD)/.deps
$(BUILD)/.deps: Makefile
	$(Q)mkdir -p $(@D) && sh tests/deps.sh $(PACKAGES) && touch $@
deps-test: $(BUILD)/.deps-test
$(BUILD)/.deps-test: Makefile $(BUILD)/.deps
	$(Q)mkdir -p $(@D) && sh tests/deps.sh $(PACKAGES) $(TEST_PACKAGES) && touch $@
deps-long: $(BUILD)/.deps-long
$(BUILD)/.deps-long: Makefile $(BUILD)/.deps-test
	$(Q)mkdir -p $(@D) && sh tests/deps.sh $(PACKAGES) $(TEST_PACKAGES) $(LONG_PACKAGES) && touch $@
deps-dev: $(BUILD)/.deps-dev
$(BUILD)/.deps-dev: Makefile $(BUILD)/.deps-test
	$(Q)mkdir -p $(@D) && sh tests/deps.sh $(PACKAGES) $(TEST_PACKAGES) $(DEV_PACKAGES) && touch $@
deps-peers: $(BUILD)/.deps-peers
$(BUILD)/.deps-peers: Makefile $(BUILD)/.deps-test
	$(Q)mkdir -p $(@D) && sh tests/deps.sh $(PACKAGES) $(TEST_PACKAGES) $(PEER_PACKAGES) && touch $@

deps-bench: $(BUILD)/.deps-bench
$(BUILD)/.deps-bench: Makefile $(BUILD)/.deps-test
	$(Q)mkdir -p $(@D) && sh tests/deps.sh $(PACKAGES) $(TEST_PACKAGES) $(BENCH_PACKAGES) && touch $@
# With access to Debian's packages, which provide PETSc.
$(BUILD)/venv-bench/.done: Makefile $(BUILD)/.deps-bench
	$(Q)/usr/bin/python3 -m venv --system-site-packages $(@D) && $(@D)/bin/pip install --quiet $(BENCH_WHEELS) && touch $@

# Debian has no package of Pixar's USD; only tests need it.
$(BUILD)/venv-usd/.done: Makefile $(BUILD)/.deps-peers
	$(Q)/usr/bin/python3 -m venv $(@D) && $(@D)/bin/pip install --quiet $(PEER_WHEELS) && touch $@

$(BUILD)/hoodoo: $(BUILD)/src/main.o $(KEEP) $(BUILD)/libhoodoo.a
	@echo "link $@"
	$(Q)$(CC) $(CFLAGS) -o $@ $^ $(LDLIBS)

$(BUILD)/libhoodoo.a: $(LIB_OBJ)
	@echo "ar $@"
	$(Q)rm -f $@ && ar rcs $@ $^

$(BUILD)/%.o: %.c | $(BUILD)/.deps $(SHARE)/gen/gpu/kernels.h
	@echo "cc $<"
	$(Q)mkdir -p $(@D) && $(CC) $(CPPFLAGS) $(CFLAGS) $(EXR_FLAGS) -MMD -MP -c -o $@ $<

$(SHARE)/%_shim.o: %_shim.cpp | $(BUILD)/.deps
	@echo "c++ $<"
	$(Q)mkdir -p $(@D) && $(CXX) $(CPPFLAGS) $(CXXFLAGS) -MMD -MP -c -o $@ $<

# Readers of untrusted files, and the library that uses OpenVDB, are separate files beside hoodoo, started or loaded on demand.
BESIDE = $(addprefix $(SHARE)/,hoodoo-read hoodoo-read-image hoodoo-read-mesh hoodoo-vdb.so)
$(BUILD)/hoodoo: | $(BESIDE)
$(BUILD)/hoodoo-read: $(BUILD)/src/read.o $(BUILD)/libhoodoo.a
	@echo "link $@"
	$(Q)$(CXX) $(OPT) -o $@ $^ $(VDB_LIBS) -lOpenEXRCore-3_1 -lseccomp
$(BUILD)/hoodoo-read-image: $(BUILD)/src/read_image.o $(BUILD)/libhoodoo.a
	@echo "link $@"
	$(Q)$(CXX) $(OPT) -o $@ $^ -lOpenImageIO -lOpenImageIO_Util -ltiff -lseccomp
$(BUILD)/hoodoo-read-mesh: $(BUILD)/src/read_mesh.o $(BUILD)/libhoodoo.a
	@echo "link $@"
	$(Q)$(CXX) $(OPT) -o $@ $^ -lassimp -lxxhash -lseccomp

# The image reader of a bundle decodes with the libraries of the formats instead of OpenImageIO.
$(BUILD)/bundle/decode_shim.o: src/image/decode_shim.cpp | $(BUILD)/.deps
	@echo "c++ $@"
	$(Q)mkdir -p $(@D) && $(CXX) $(CPPFLAGS) -DHOODOO_OWN_FORMATS $(CXXFLAGS) -MMD -MP -c -o $@ $<
$(BUILD)/bundle/hoodoo-read-image: $(BUILD)/src/read_image.o $(BUILD)/bundle/decode_shim.o $(BUILD)/libhoodoo.a
	@echo "link $@"
	$(Q)$(CXX) $(OPT) -o $@ $^ -lOpenEXR-3_1 -lImath-3_1 -ltiff -ljpeg -lpng16 -lseccomp

VDB_OBJ = $(patsubst %,$(SHARE)/src/%_shim.o,vdb/bytes vdb/points vdb/volumes meshinput/sdf shape/function) \
	$(patsubst %,$(BUILD)/src/%.o,system/draft base/hash base/memory base/status text/text base/version job/values particles/rock)
$(VDB_OBJ): private PIC = -fPIC
$(VDB_OBJ): src/vdb.map
$(BUILD)/hoodoo-vdb.so: $(VDB_OBJ) src/vdb.map
	@echo "link $@"
	$(Q)$(CXX) $(OPT) -shared -Wl,--version-script=src/vdb.map -Wl,-Bsymbolic -Wl,-z,defs -o $@ $(VDB_OBJ) $(VDB_LIBS) -lmuparser

# The objects that determine the results of a simulation and the contents of a frame's files. Their hash identifies a build:
# objects instead of sources, since compiler and flags matter and comments do not. Debug information, which contains paths, is
# stripped. Verbs, the control of a run, the farm and previews are not part of it.
COMPUTES = $(sort $(filter-out $(addprefix $(BUILD)/,src/base/version.o src/cli/% src/run/% src/look/% src/selftest/% farm/% render/% gen/render/%),$(LIB_OBJ)))
$(BUILD)/gen/build: $(COMPUTES) Makefile
	$(Q)ld -r -S -o $@.o $(COMPUTES) && { echo $(VERSION); cat $@.o; } | sha256sum | cut -c 1-16 > $@ && rm $@.o

# Version, commit and build are in a single object, so that a commit rebuilds nothing else.
$(BUILD)/src/base/version.o: private CPPFLAGS += -DHOODOO_VERSION='"$(VERSION)"' -DHOODOO_COMMIT='"$(COMMIT)"' \
	-DHOODOO_BUILD='"$(shell cat $(SHARE)/gen/build)"'
$(BUILD)/src/base/version.o: $(SHARE)/gen/build $(wildcard $(addprefix $(shell git rev-parse --git-dir 2>/dev/null)/,HEAD logs/HEAD))

# ---- shaders: GLSL to three SPIR-V variants, validated and embedded, one folder at a time

GLSLANG = -lglslang -lMachineIndependent -lGenericCodeGen -lOSDependent -lOGLCompiler -lSPIRV -lglslang-default-resource-limits \
	-lSPIRV-Tools-opt -lSPIRV-Tools
$(SHARE)/embed_kernels: src/embed_kernels.c | $(BUILD)/.deps
	@echo "cc $<"
	$(Q)$(CC) -std=c11 -D_GNU_SOURCE $(WARN) -O1 -o $@ $< $(GLSLANG) -lstdc++ -lm -lpthread

$(SHARE)/gen/gpu/kernels.h: $(SHADER) src/gpu/embed.sh | $(BUILD)/.deps
	$(Q)mkdir -p $(@D) && sh src/gpu/embed.sh header $(sort $(SHADER)) > $@.tmp && if cmp -s $@.tmp $@; then rm $@.tmp; else mv $@.tmp $@; fi
$(SHARE)/gen/gpu/kernels.c: $(SHARE)/gen/gpu/kernels.h src/gpu/embed.sh
	$(Q)sh src/gpu/embed.sh table $(sort $(SHADER)) > $@.tmp && mv $@.tmp $@
define kernels_rule
$(SHARE)/gen/gpu/$(1).c: $(filter shaders/$(1)/%,$(SHADER)) $(SHARE)/gen/gpu/kernels.h $(SHARE)/embed_kernels
	@echo "glsl shaders/$(1)"
	$$(Q)$(SHARE)/embed_kernels $$(@:%.c=%) $(sort $(filter shaders/$(1)/%,$(SHADER)))
endef
$(foreach k,$(filter-out kernels,$(KERNELS)),$(eval $(call kernels_rule,$(k))))
$(BUILD)/gen/gpu/%.o: $(SHARE)/gen/gpu/%.c $(SHARE)/gen/gpu/kernels.h src/gpu/kernel_source.h
	@echo "cc $<"
	$(Q)mkdir -p $(@D) && $(CC) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

# ---- POV-Ray text, HTML, CSS and JavaScript of scenes and pages, embedded as lines

SCENE = $(sort $(wildcard render/*.inc render/*.css render/*.js render/*.html))
$(SHARE)/gen/render/scene_parts.c: $(SCENE) src/embed_text.sh
	$(Q)mkdir -p $(@D) && sh src/embed_text.sh $(SCENE) > $@.tmp && mv $@.tmp $@
$(BUILD)/gen/render/scene_parts.o: $(SHARE)/gen/render/scene_parts.c render/scene_parts.h render/page_parts.h
	@echo "cc $<"
	$(Q)mkdir -p $(@D) && $(CC) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

# Jobs that need no other files.
EXAMPLES = $(filter-out $(patsubst %.png,%.yaml,$(wildcard jobs/*.png)),$(sort $(wildcard jobs/*.yaml)))
$(SHARE)/gen/cli/examples.c: $(EXAMPLES) src/embed_text.sh
	$(Q)mkdir -p $(@D) && sh src/embed_text.sh $(EXAMPLES) > $@.tmp && mv $@.tmp $@
$(BUILD)/gen/cli/examples.o: $(SHARE)/gen/cli/examples.c src/cli/examples.h
	@echo "cc $<"
	$(Q)mkdir -p $(@D) && $(CC) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

# ---- demo, tests

## demo: erode an arch for 60 frames into out/demo and make its stills and turntable (no GPU needed)
demo: $(BUILD)/hoodoo
	$(Q)sh jobs/demo.sh $(BUILD)/hoodoo

$(BUILD)/tests/%: tests/%.c $(BUILD)/libhoodoo.a $(TEST_HELP) $(KEEP) | $(BESIDE) $(BUILD)/.deps-test
	@echo "test $<"
	$(Q)mkdir -p $(@D) && $(CC) $(CPPFLAGS) -Itests $(CFLAGS) $(EXR_FLAGS) -MMD -MP -o $@ $< $(TEST_HELP) $(KEEP) $(BUILD)/libhoodoo.a \
		-lcmocka $(LDLIBS) -lseccomp

# A checker of meshes that uses CGAL. It is not part of hoodoo and not linked with it, since CGAL's licence is the GPL.
JUDGE = $(CXX) -std=c++17 -O2 -frounding-math -w -DCGAL_EIGEN3_ENABLED -isystem /usr/include/eigen3 -isystem /usr/include/Imath
$(BUILD)/tests/ref/mesh_check $(BUILD)/tests/bench/surface: $(BUILD)/%: %_shim.cpp | $(BUILD)/.deps-test
	@echo "c++ $<"
	$(Q)mkdir -p $(@D) && $(JUDGE) -o $@ $< -lopenvdb -ltbb -lImath-3_1 -lmpfr -lgmp -lpthread

# Parsers of untrusted input under libFuzzer.
FUZZ_BIN = $(patsubst %.c,$(BUILD)/%,$(wildcard tests/fuzz/*.c))
$(BUILD)/tests/fuzz/%: tests/fuzz/%.c tests/fuzz/fuzz.h $(BUILD)/libhoodoo.a
	@echo "fuzz $<"
	$(Q)mkdir -p $(@D) && $(CC) $(CPPFLAGS) -Itests $(CFLAGS) -fsanitize=fuzzer -o $@ $< $(BUILD)/libhoodoo.a $(LDLIBS) -lseccomp

## test: build and run the tests (under 20 minutes on 2 cores)
test: $(BUILD)/hoodoo $(BUILD)/bundle/hoodoo-read-image $(BUILD)/.deps-test $(TEST_BIN) $(BUILD)/tests/ref/mesh_check
	$(Q)HOODOO_TEST_BUT=tests/later sh tests/run.sh $(BUILD) unit gpu physics restart cli

## test-later: tests of the same folders that take minutes each; .ci/run runs them, too
test-later: $(BUILD)/hoodoo $(BUILD)/.deps-test $(TEST_BIN)
	$(Q)sh tests/run.sh $(BUILD) $$(cat tests/later)

## test-peers: Slurm, OpenJD, Blender, USD, Chromium and others with hoodoo's files (large packages)
test-peers: $(BUILD)/hoodoo $(BUILD)/$(BUNDLE).tar.zst $(BUILD)/.deps-peers $(BUILD)/venv-usd/.done
	$(Q)sh tests/run.sh $(BUILD) peers

## test-long: slow proofs: every interruption, resolutions, sweeps
test-long: $(BUILD)/hoodoo $(BUILD)/$(BUNDLE).tar.zst $(BUILD)/.deps-long $(TEST_BIN)
	$(Q)sh tests/run.sh $(BUILD) long

FAULTS = physics/test_numbers restart/products.py restart/repair.py restart/killed.py restart/full_disk.sh restart/faults.py restart/readers.py restart/test_checkpoint_state
## faults: run the fault campaigns and write their table into tests/README.md
faults: $(BUILD)/hoodoo $(BUILD)/.deps-test $(BUILD)/tests/physics/test_numbers $(BUILD)/tests/restart/test_checkpoint_state
	$(Q)HOODOO_FAULTS=write sh tests/run.sh $(BUILD) $(FAULTS)

## bench: measure speed beside plain C and other programs, in one run; BENCH='--only water' for some (tests/bench/run.py -h)
bench: $(BUILD)/hoodoo $(BUILD)/.deps-bench $(BUILD)/venv-bench/.done $(BENCH_BIN)
	$(Q)/usr/bin/python3 tests/bench/run.py $(BUILD) $(BENCH)

## bench-compare: the differences between two results: make bench-compare A=OLD.json B=NEW.json
bench-compare:
	$(Q)/usr/bin/python3 tests/bench/run.py compare $(A) $(B)

## reference: write jobs/README.md and jobs/schema.json from the tables of keys and values
reference: $(BUILD)/tests/unit/test_job
	$(Q)cd $$(mktemp -d) && HOODOO_TOP=$(CURDIR) HOODOO_UPDATE=1 $(CURDIR)/$(BUILD)/tests/unit/test_job >/dev/null 2>&1

## gallery: draw all jobs again and write jobs/GALLERY.md (a few minutes)
gallery: $(BUILD)/hoodoo
	$(Q)sh jobs/gallery.sh $(CURDIR)/$(BUILD)/hoodoo

## format: apply .clang-format to all C
format:
	$(Q)clang-format -i $(shell find src farm render tests -name '*.[ch]' -o -name '*_shim.cpp')

## lint: warnings of both compilers, layout, headers that compile alone, folder boundaries, prose
lint: $(BUILD)/hoodoo $(BUILD)/.deps-dev $(BUILD)/gen/gpu/kernels.h
	$(Q)sh tests/run.sh $(BUILD) lint.sh

## tidy: clang-tidy and cppcheck on all C (minutes)
tidy: $(BUILD)/hoodoo $(BUILD)/.deps-dev
	$(Q)sh tests/deps.sh $(TIDY_PACKAGES) && sh tests/tidy.sh

# Sanitizer builds instrument the C only and share shaders and C++ with the ordinary build: half of the C++ is templates of
# OpenVDB, which take minutes to compile with checks, and the thread sanitizer cannot see synchronisation inside libraries
# without instrumentation. They also share the files beside hoodoo and the hash of the build: the memory limit of a reader is
# too small for what a sanitizer reserves. Tests run a quarter of their random cases (tests/effort.h) to save time.
SHARED = $(KERNELS:%=$(SHARE)/gen/gpu/%.c) $(SHARE)/gen/render/scene_parts.c $(SHARE)/gen/cli/examples.c $(SHARE)/gen/build $(SHIM_OBJ) $(BESIDE)
SANITIZED = SHARE=$(SHARE) OPT='-O1 -g1' HOODOO_TEST_EFFORT=$(or $(HOODOO_TEST_EFFORT),0.25) test-sanitized
## test-asan: the unit and gpu tests under the address, leak and undefined behaviour sanitizers
# Compiled by clang with coverage counters, so that `make fuzz` can use the same objects. The C++ runtime is linked explicitly,
# since libraries that are loaded later throw and allocate with it.
ASAN = SHARE=$(SHARE) BUILD=build-asan CC=clang OPT='-O1 -g1' LDLIBS='$(LDLIBS) -Wl,--no-as-needed -lstdc++' \
	SANITIZE='-fsanitize=address,undefined,fuzzer-no-link -fsanitize-link-c++-runtime -fno-sanitize-recover=all -fno-omit-frame-pointer'
test-asan: $(BUILD)/.deps-dev $(SHARED)
	$(Q)LSAN_OPTIONS=suppressions=$(CURDIR)/tests/lsan.supp:print_suppressions=0 $(MAKE) $(SANITIZED) $(ASAN)

## test-tsan: the unit and gpu tests under the thread sanitizer
# Compiled by clang, whose OpenMP library reports synchronisation to the sanitizer; with gcc's, every parallel loop looks like
# a race. Accesses inside libraries (Mesa, TBB, OpenMP) are ignored, since their synchronisation is not visible.
test-tsan: $(BUILD)/.deps-dev $(SHARED)
	$(Q)TSAN_OPTIONS=suppressions=$(CURDIR)/tests/tsan.supp:print_suppressions=0:ignore_noninstrumented_modules=1 \
		$(MAKE) $(SANITIZED) BUILD=build-tsan CC=clang SANITIZE=-fsanitize=thread

## fuzz: FUZZ_SECONDS (30) of libFuzzer per parser of untrusted bytes, under the address and undefined behaviour sanitizers
fuzz: $(BUILD)/.deps-dev $(SHARED)
	$(Q)$(MAKE) $(ASAN) fuzz-built
fuzz-built: $(BUILD)/.deps-test $(FUZZ_BIN)
	$(Q)bash tests/fuzz/run.sh $(BUILD)

test-sanitized: $(BUILD)/.deps-test $(filter $(BUILD)/tests/unit/% $(BUILD)/tests/gpu/%,$(TEST_BIN))
	$(Q)sh tests/run.sh $(BUILD) unit gpu

## install: copy hoodoo to PREFIX/bin, helpers to PREFIX/libexec/hoodoo, manual, completion, examples and licence to PREFIX/share (default /usr/local)
PREFIX = /usr/local
install: $(BUILD)/hoodoo
	install -D -m 755 $(BUILD)/hoodoo $(DESTDIR)$(PREFIX)/bin/hoodoo
	install -D -m 755 -t $(DESTDIR)$(PREFIX)/libexec/hoodoo $(BESIDE)
	sh src/cli/man.sh $(BUILD)/hoodoo > $(BUILD)/hoodoo.1 && install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/man/man1 $(BUILD)/hoodoo.1
	install -D -m 644 src/cli/complete/hoodoo.bash $(DESTDIR)$(PREFIX)/share/bash-completion/completions/hoodoo
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/zsh/site-functions src/cli/complete/_hoodoo
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/fish/vendor_completions.d src/cli/complete/hoodoo.fish
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/hoodoo/jobs jobs/*.yaml jobs/*.png jobs/*.json jobs/README.md jobs/TUTORIAL.md
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/doc/hoodoo LICENSE CHANGELOG.md README.md

STAGE = $(BUILD)/bundle/$(BUNDLE)
LAUNCHED = hoodoo hoodoo-read hoodoo-read-image hoodoo-read-mesh
$(BUILD)/bundle/launch: farm/bundle/launch.c | $(BUILD)/.deps
	$(Q)mkdir -p $(@D) && $(CC) -std=c11 -D_GNU_SOURCE $(WARN) -Os -static -s -o $@ $<
$(BUILD)/bundle/host-libc: farm/bundle/host_libc.c | $(BUILD)/.deps
	$(Q)mkdir -p $(@D) && $(CC) -std=c11 $(WARN) -O1 -s -o $@ $<
$(BUILD)/bundle/host-libstdc++: farm/bundle/host_libstdcxx_shim.cpp | $(BUILD)/.deps
	$(Q)mkdir -p $(@D) && $(CXX) -std=c++17 -O0 -s -o $@ $<

## bundle: pack hoodoo and its libraries into build/hoodoo-VERSION-linux-x86_64.tar.zst, which runs on any x86-64 Linux
bundle: $(BUILD)/$(BUNDLE).tar.zst
$(BUILD)/$(BUNDLE).tar.zst: $(BUILD)/hoodoo $(addprefix $(BUILD)/bundle/,hoodoo-read-image launch host-libc host-libstdc++) farm/bundle/collect.py farm/bundle/README.md
	$(Q)rm -rf $(STAGE) && $(MAKE) --no-print-directory install DESTDIR=$(STAGE) PREFIX= >/dev/null
	$(Q)mkdir -p $(STAGE)/lib/programs && cp farm/bundle/README.md $(STAGE)
	$(Q)cp $(BUILD)/bundle/hoodoo-read-image $(STAGE)/libexec/hoodoo/
	$(Q)mv $(STAGE)/bin/hoodoo $(STAGE)/libexec/hoodoo/hoodoo-read* $(STAGE)/lib/programs/ && cp $(addprefix $(BUILD)/bundle/,host-libc host-libstdc++) $(STAGE)/lib/programs/
	$(Q)cp $(BUILD)/bundle/launch $(STAGE)/bin/hoodoo
	$(Q)for p in $(filter-out hoodoo,$(LAUNCHED)); do cp $(BUILD)/bundle/launch $(STAGE)/libexec/hoodoo/$$p; done
	$(Q)strip $(addprefix $(STAGE)/lib/programs/,$(LAUNCHED)) $(STAGE)/libexec/hoodoo/hoodoo-vdb.so
	$(Q)/usr/bin/python3 farm/bundle/collect.py $(STAGE) $@

## deb: pack what `make install` installs as build/hoodoo_VERSION-1_ARCHITECTURE.deb, a package for this release of Debian
deb: $(BUILD)/hoodoo
	$(Q)sh farm/bundle/deb.sh $(BUILD) $(VERSION)

## clean: remove all build folders (out/ stays)
clean:
	rm -rf build build-asan build-tsan

## help: list the targets
help:
	@sed -n 's/^## \([a-z-]*\): /\1\t/p' Makefile | expand -t 14

.PHONY: all deps deps-test deps-long deps-dev deps-peers deps-bench demo test test-later test-peers test-long faults bench bench-compare reference gallery format lint tidy test-asan test-tsan test-sanitized fuzz fuzz-built install bundle deb clean help
.DEFAULT_GOAL = all
.DELETE_ON_ERROR:
-include $(shell find $(BUILD) -type f -name '*.d' 2>/dev/null)
