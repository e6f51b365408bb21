# libnlcontact.  GNU make; `make help` lists the targets.  All output goes under $(B).
.DELETE_ON_ERROR:
.SECONDARY:
.SUFFIXES:

VERSION := $(shell sed -n 's/^.define NLC_VERSION_[A-Z]* //p' $(dir $(lastword $(MAKEFILE_LIST)))include/nlcontact.h | paste -sd. -)
# Raised only by what breaks a program built with an older header, whatever the version is then called: see CONTRIBUTING.
SO_MAJOR := 0

# Compilers note the folder that PWD names: let it be the one that PREFIX_MAP replaces, not a symbolic link to it.
export PWD := $(CURDIR)
S := $(patsubst %/,%,$(dir $(lastword $(MAKEFILE_LIST))))
B ?= build
PREFIX ?= /usr/local
prefix ?= $(PREFIX)
exec_prefix ?= $(prefix)
includedir ?= $(prefix)/include
libdir ?= $(exec_prefix)/lib
datarootdir ?= $(prefix)/share
mandir ?= $(datarootdir)/man
pkgconfigdir ?= $(libdir)/pkgconfig
cmakedir ?= $(libdir)/cmake/nlcontact
DESTDIR ?=
INSTALL ?= install
CROSS_COMPILE ?=
ifeq ($(origin CC),default)
CC := $(CROSS_COMPILE)gcc
endif
ifeq ($(origin CXX),default)
CXX := $(CROSS_COMPILE)g++
endif
ifeq ($(origin FC),default)
FC := $(CROSS_COMPILE)gfortran
endif
ifeq ($(origin AR),default)
AR := $(CROSS_COMPILE)ar
endif
PKG_CONFIG ?= pkg-config
EMULATOR ?=

# The user's CFLAGS come last.  WARNINGS=-Werror... is CI's affair.
CFLAGS ?= -O3 -g
CXXFLAGS ?= -O2 -g
FFLAGS ?= -O2 -g
WARNINGS ?= -Wall -Wextra
ALL_CPPFLAGS = -I$(S)/include $(CPPFLAGS)
ALL_CFLAGS = -std=c11 $(WARNINGS) -ffile-prefix-map=$(S)/= $(CFLAGS)
# No contraction into fused multiply-adds behind our back, and no errno from sqrt: results and flags are as written.
# No folder's name in debug information either: the same bytes wherever it is built.
PREFIX_MAP = $(if $(filter-out /,$(CURDIR)),'-ffile-prefix-map=$(CURDIR)=.') -ffile-prefix-map=$(S)/lib=lib -ffile-prefix-map=$(S)/include=include
LIB_CFLAGS = -std=c11 $(WARNINGS) -fPIC -fvisibility=hidden -ffp-contract=off -fno-math-errno $(PREFIX_MAP) $(CFLAGS)
DEPFLAGS = -MMD -MP
LIBS := -lm
comma := ,
# The shared library is linked with all it needs; sanitized ones get it from the program.
NO_UNDEFINED ?= -Wl,-z,defs

LIB_SRC := $(sort $(wildcard $(S)/lib/*.c $(S)/lib/*/*.c))
LIB_OBJ := $(LIB_SRC:$(S)/%.c=$(B)/%.o)
STATIC := $(B)/libnlcontact.a
SONAME := libnlcontact.so.$(SO_MAJOR)
SHARED := $(B)/libnlcontact.so.$(VERSION)
PC := $(B)/nlcontact.pc
CMAKE := $(B)/nlcontact-config.cmake $(B)/nlcontact-config-version.cmake
MAN := $(sort $(wildcard $(S)/man/*.[37]))

.PHONY: all help lib demo bench accuracy figures packing examples check stress setup install uninstall dist deb distcheck clean hydrogel hydrogel-runs bench-large plots setup-plots record-instructions setup-examples coordination energy FORCE
all: lib packing ## build the libraries and the packing program
lib: $(STATIC) $(SHARED) ## build the static and the shared library

help: ## list the targets
	@sed -n 's/^\([a-z][a-z-]*\):.*## \(.*\)/  make \1\t\2/p' $(S)/Makefile | expand -t 20
	@echo "  variables: CC CFLAGS PREFIX DESTDIR libdir B (build folder) EMULATOR (prefix for running tests)"

$(B)/lib/%.o: $(S)/lib/%.c
	@mkdir -p $(@D)
	$(CC) $(DEPFLAGS) $(ALL_CPPFLAGS) $(LIB_CFLAGS) -c $< -o $@

$(STATIC): $(LIB_OBJ)
	rm -f $@
	$(AR) rcD $@ $^

$(SHARED): $(LIB_OBJ) $(S)/lib/nlcontact.map
	$(CC) -shared -Wl,-soname,$(SONAME) -Wl,--version-script=$(S)/lib/nlcontact.map $(NO_UNDEFINED) $(LDFLAGS) \
		-o $@ $(LIB_OBJ) $(LIBS)
	ln -sf $(@F) $(B)/$(SONAME)
	ln -sf $(SONAME) $(B)/libnlcontact.so

# Directories below the prefix are written relative to it, so that the file survives `pkg-config --define-prefix`.
# Made anew by every install: it depends on variables, not on files.
$(PC): FORCE
	@mkdir -p $(@D)
	sed -e 's|@prefix@|$(prefix)|' -e 's|@exec_prefix@|$(patsubst $(prefix)%,$${prefix}%,$(exec_prefix))|' \
		-e 's|@libdir@|$(patsubst $(exec_prefix)/%,$${exec_prefix}/%,$(libdir))|' \
		-e 's|@includedir@|$(patsubst $(prefix)/%,$${prefix}/%,$(includedir))|' -e 's|@version@|$(VERSION)|' $(S)/nlcontact.pc.in > $@

$(B)/%.cmake: $(S)/%.cmake.in FORCE
	@mkdir -p $(@D)
	sed -e 's|@libdir@|$(libdir)|' -e 's|@includedir@|$(includedir)|' -e 's|@cmakedir@|$(cmakedir)|' -e 's|@soname@|$(SONAME)|' \
		-e 's|@version@|$(VERSION)|' $< > $@

# ---- programs on a packing, and on single spheres
BENCH_SRC := $(sort $(wildcard $(S)/bench/*.c))
BENCH_MAIN := $(filter %/packing.c %/bench.c %/steps.c %/roofline.c %/accuracy.c \
	%/coordination.c %/functions.c %/tradeoff.c %/scale.c %/instructions.c %/energy.c %/skipping.c %/kept.c,$(BENCH_SRC))
BENCH_COMMON := $(patsubst $(S)/%.c,$(B)/%.o,$(filter-out $(BENCH_MAIN),$(BENCH_SRC)))

$(B)/bench/%.o: $(S)/bench/%.c
	@mkdir -p $(@D)
	$(CC) $(DEPFLAGS) -I$(S)/bench $(ALL_CPPFLAGS) -D_POSIX_C_SOURCE=200809L $(ALL_CFLAGS) -c $< -o $@
$(B)/bench/%: $(B)/bench/%.o $(BENCH_COMMON) $(STATIC)
	$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $^ $(LIBS)

$(B)/bench/skipping: LIBS += $(patsubst %,-Wl$(comma)--wrap=nlc_%,is_loose is_solved settle_region solve_clusters)

packing: $(B)/bench/packing ## build bench/packing, the same for a packing of your own
demo: $(B)/bench/packing ## a real packing: forces with and without the coupling, a table, a picture, a ParaView file
	@$(B)/bench/packing --svg $(B)/demo.svg --vtk $(B)/demo.vtk $(S)/bench/data/b_die125_rd0.80.csv
PACKING ?= $(S)/bench/data/a_mono1000_periodic.csv
RESULTS ?= $(B)/results
TRADEOFF_PACKINGS = $(sort $(S)/bench/data/b_die125_rd0.80.csv $(S)/bench/data/a_mono1000_periodic.csv \
	$(S)/bench/data/c_hydrogel514_strain13.csv $(PACKING))
bench: $(addprefix $(B)/bench/,bench roofline steps functions tradeoff skipping kept scale) ## time the library against Algorithm 1 as printed; PACKING=file for a packing of your own
	@mkdir -p $(RESULTS)
	@$(B)/bench/bench $(PACKING) ordered:$(PACKING)
	@$(B)/bench/bench --csv $(PACKING) ordered:$(PACKING) >$(RESULTS)/bench.csv
	@$(B)/bench/roofline $(PACKING) ordered:$(PACKING)
	@$(B)/bench/steps $(PACKING)
	@$(B)/bench/functions --csv $(RESULTS)/functions.csv $(PACKING)
	@$(B)/bench/tradeoff --csv $(RESULTS)/tradeoff.csv $(TRADEOFF_PACKINGS)
	@$(B)/bench/kept $(PACKING)
	@$(B)/bench/skipping --csv $(RESULTS)/skipping.csv $(PACKING)
	@$(B)/bench/scale --csv $(RESULTS)/scale.csv
bench-large: $(B)/bench/tradeoff $(B)/bench/scale ## the same on ten million contacts; some 20 minutes and 6 GB
	@mkdir -p $(RESULTS)
	@$(B)/bench/scale --csv $(RESULTS)/scale_large.csv 1.1e7
	@$(B)/bench/tradeoff --csv $(RESULTS)/tradeoff_large.csv ordered:lattice:75
PLOTS ?= $(B)/plots
plots: ## pictures of what make bench and bench-large have found, in build/plots (needs gnuplot: make setup-plots)
	@command -v gnuplot >/dev/null || { echo 'no gnuplot: make setup-plots'; exit 1; }
	@[ -e $(RESULTS)/tradeoff.csv ] && [ -e $(RESULTS)/scale.csv ] || { echo 'nothing in $(RESULTS): make bench'; exit 1; }
	@mkdir -p $(PLOTS)
	@for p in tradeoff scale; do gnuplot -e "folder='$(S)/bench/plots'; results='$(RESULTS)'; out='$(PLOTS)'" \
		$(S)/bench/plots/$$p.gp && echo $(PLOTS)/$$p.png || exit 1; done
record-instructions: $(B)/bench/instructions ## count the instructions of every function anew, for the test that compares them (valgrind)
	@sh $(S)/bench/count_instructions $(STATIC) $< >$(B)/instructions.csv && mv $(B)/instructions.csv $(S)/tests/instructions.csv
energy: $(B)/bench/energy ## a packing that vibrates undamped: what its energy does, by how forces are found; build/energy.csv, .svg
	@$(B)/bench/energy --csv $(B)/energy.csv --svg $(B)/energy.svg $(S)/bench/data/b_die125_rd0.70.csv
coordination: $(B)/bench/coordination ## one sphere with ever more others on it: time beside that of all pairs
	@$(B)/bench/coordination
REFERENCES = $(filter-out %/hertz_pressure.csv,$(foreach d,reference fe,$(sort $(wildcard $(S)/bench/data/$(d)/*.csv))))
accuracy: $(B)/bench/accuracy ## the models' forces beside exact elasticity and finite elements, and their cost: tables, charts
	@$(B)/bench/accuracy --csv $(B)/accuracy.csv --svg $(B)/accuracy.svg --packing $(PACKING) --cost $(B)/accuracy_cost.svg \
		--surface $(S)/bench/data/reference/hertz_pressure.csv $(REFERENCES)

# ---- the runs that [MC]'s figures are drawn from; `make hydrogel-runs` computes them anew
HYDROGEL := $(B)/bench/hydrogel/compress $(B)/bench/hydrogel/mc_metrics
HYDROGEL_RUNS := $(B)/bench/hydrogel/run.o $(B)/bench/hydrogel/metrics.o
$(B)/bench/hydrogel/compress: $(B)/bench/hydrogel/bed.o $(B)/bench/hydrogel/measure.o
$(HYDROGEL): %: %.o $(HYDROGEL_RUNS) $(BENCH_COMMON) $(STATIC)
	$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(STATIC) $(LIBS)
hydrogel: $(HYDROGEL) ## bench/hydrogel: compression of a packing by several models, and [MC]'s measures of two runs
RUNS := $(B)/hydrogel
RUN = @mkdir -p $(@D); cd $(@D) && $(abspath $<) $(1) --output $(@F) $(abspath $(S))/bench/data/c_hydrogel514_rest.csv
$(RUNS)/mc-sphere.csv: $(B)/bench/hydrogel/compress $(RUNS)/sphere.csv
	$(call RUN,--fit sphere.csv --prefactor 0.84)
$(RUNS)/mc-paper.csv: $(B)/bench/hydrogel/compress $(RUNS)/hertz.csv
	$(call RUN,--fit hertz.csv --ratio 2.3256 --prefactor 1.525)
$(RUNS)/%.csv: $(B)/bench/hydrogel/compress
	$(call RUN,--model $*)
RUN_NAMES := sphere hertz mc-paper mc-sphere half-space point-force gonzalez-cuitino
hydrogel-runs: $(RUN_NAMES:%=$(RUNS)/%.csv) ## compute [MC]'s runs anew, in build/hydrogel; some minutes with -j2

# ---- the figures of [GC] and [MC]
FIGURES := $(B)/bench/figures/figures
FIGURES_OBJ := $(patsubst $(S)/%.c,$(B)/%.o,$(sort $(wildcard $(S)/bench/figures/*.c)))
$(FIGURES): $(FIGURES_OBJ) $(HYDROGEL_RUNS) $(patsubst %,$(B)/bench/%.o,line_chart reference_table packing_io timing) $(STATIC)
	$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $^ $(LIBS)
BEDS := $(B)/bench/figures/bed/compact
$(BEDS): $(patsubst $(S)/%.c,$(B)/%.o,$(sort $(wildcard $(S)/bench/figures/bed/*.c))) $(STATIC)
	$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $^ $(LIBS)
figures: $(FIGURES) $(BEDS) ## the figures of [GC] and [MC] as pictures and data, in build/figures; four minutes
	@mkdir -p $(B)/figures
	@$(BEDS) $(B)/figures
	@$(FIGURES) $(S)/bench $(B)/figures $(B)/figures
	@if command -v rsvg-convert >/dev/null; then \
		for f in $(B)/figures/*.svg; do rsvg-convert -o "$${f%.svg}.png" "$$f" || exit 1; done; \
	else echo 'no rsvg-convert: no PNG pictures, only SVG'; fi

# ---- other languages; Fortran only where there is a compiler
EXAMPLES := $(B)/examples/packing-c++ $(if $(shell command -v $(FC) 2>/dev/null),$(B)/examples/packing-fortran)

# LAMMPS as a host, where there is one that this compiler's programs can be linked with
LAMMPS_SRC := $(filter-out %/plot.c,$(sort $(wildcard $(S)/examples/lammps/*.c)))
LAMMPS_PKG = $(shell $(PKG_CONFIG) --$(1) liblammps mpi-c 2>/dev/null)
ifeq ($(shell $(PKG_CONFIG) --exists liblammps mpi-c 2>/dev/null && $(CC) -dumpmachine | cut -d- -f1),$(shell uname -m))
EXAMPLES += $(B)/examples/nlc-lammps
endif
$(B)/examples/lammps/%.o: $(S)/examples/lammps/%.c
	@mkdir -p $(@D)
	$(CC) $(DEPFLAGS) $(ALL_CPPFLAGS) -D_POSIX_C_SOURCE=200809L $(call LAMMPS_PKG,cflags) -fno-math-errno $(ALL_CFLAGS) -c $< -o $@
$(B)/examples/nlc-lammps: $(LAMMPS_SRC:$(S)/%.c=$(B)/%.o) $(STATIC)
	$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $^ $(call LAMMPS_PKG,libs) $(LIBS)
-include $(wildcard $(B)/examples/lammps/*.d)

$(B)/examples/packing-c++: $(S)/examples/packing.cc $(S)/examples/nlcontact.hpp $(S)/include/nlcontact.h $(STATIC)
	@mkdir -p $(@D)
	$(CXX) -std=c++11 -I$(S)/include $(CPPFLAGS) $(WARNINGS) $(CXXFLAGS) $(LDFLAGS) -o $@ $(filter %.cc %.a,$^) $(LIBS)
$(B)/examples/packing-fortran: $(S)/include/nlcontact.f90 $(S)/examples/packing.f90 $(STATIC)
	@mkdir -p $(@D)
	$(FC) -J$(@D) $(WARNINGS) $(FFLAGS) $(LDFLAGS) -o $@ $^ $(LIBS)
examples: $(EXAMPLES) ## the packing in C++ and, with a compiler for it, in Fortran, nlc-lammps where LAMMPS is; Python needs no building

# ---- tests
TEST_SRC := $(sort $(wildcard $(S)/tests/test_*.c))
TEST_COMMON := $(patsubst $(S)/%.c,$(B)/%.o,$(filter-out $(TEST_SRC),$(sort $(wildcard $(S)/tests/*.c))))
TESTS := $(TEST_SRC:$(S)/%.c=$(B)/%)
TEST_SCRIPTS := $(sort $(wildcard $(S)/tests/test_*.sh))
CHECK_CFLAGS = $(shell $(PKG_CONFIG) --cflags check 2>/dev/null)
CHECK_LIBS = $(shell $(PKG_CONFIG) --libs check 2>/dev/null || echo -lcheck)

$(B)/tests/%.o: $(S)/tests/%.c
	@mkdir -p $(@D)
	$(CC) $(DEPFLAGS) -I$(S)/tests -I$(S)/bench $(ALL_CPPFLAGS) -D_GNU_SOURCE -DNLC_SOURCE_DIR='"$(abspath $(S))"' $(CHECK_CFLAGS) \
		-ffp-contract=off $(ALL_CFLAGS) -c $< -o $@
$(B)/tests/%: $(B)/tests/%.o $(TEST_COMMON) $(BENCH_COMMON) $(STATIC)
	$(CC) $(ALL_CFLAGS) $(LDFLAGS) -pthread -o $@ $^ $(CHECK_LIBS) $(LIBS)

check: lib packing $(FIGURES) $(BEDS) $(HYDROGEL) $(TESTS) $(addprefix $(B)/bench/,accuracy functions tradeoff skipping kept scale instructions energy) ## build and run every test (needs what `make setup` installs)
	@S='$(abspath $(S))' B='$(abspath $(B))' CC='$(CC)' CXX='$(CXX)' FC='$(FC)' MAKE='$(MAKE)' EMULATOR='$(EMULATOR)' \
		PKG_CONFIG='$(PKG_CONFIG)' VERSION='$(VERSION)' sh $(S)/tests/run $(abspath $(TESTS) $(TEST_SCRIPTS))

# ---- the ABI, recorded in tests/abi/x.y for each release x.y
.PHONY: abi-check abi-baseline abi-dump
ABI := $(S)/tests/abi/$(basename $(VERSION))
ABIDW_FLAGS := --headers-dir $(S)/include --no-corpus-path --no-comp-dir-path --no-show-locs --type-id-style hash \
	--drop-private-types --drop-undefined-syms --exported-interfaces-only
abi-check: lib ## compare the ABI with what is recorded of this release and of older ones; needs abidiff
	@command -v abidiff >/dev/null || { echo 'abi-check needs abidiff, from abigail-tools'; exit 1; }
	@S='$(abspath $(S))' B='$(abspath $(B))' CC='$(CC)' MAKE='$(MAKE)' EMULATOR='$(EMULATOR)' VERSION='$(VERSION)' \
		sh $(S)/tests/test_abi.sh
abi-baseline: ## record the ABI of this release anew; needs gcc on x86-64, python3 and abidw
	@mkdir -p $(ABI)
	python3 $(S)/tools/abi.py header $(S)/include/nlcontact.h > $(ABI)/nlcontact.h
	python3 $(S)/tools/abi.py layout $(S)/include/nlcontact.h $(S)/lib/nlcontact.map > $(ABI)/layout
	@$(MAKE) -s B=$(B)/abi CC=gcc CFLAGS='-O0 -g' LDFLAGS= abi-dump
	cp $(B)/abi/libnlcontact.abi $(ABI)/
	python3 $(S)/tools/abi.py symbols $(S)/lib/nlcontact.map > $(S)/debian/libnlcontact0.symbols
abi-dump: $(SHARED)
	abidw $(ABIDW_FLAGS) $(SHARED) > $(B)/libnlcontact.abi

# ---- fuzzing: with FUZZ_MAIN= and -fsanitize=fuzzer these are libFuzzer's, as they are here they replay files
.PHONY: fuzz fuzz-programs analyse platforms mutants audit
FUZZ := $(patsubst $(S)/%.c,$(B)/%,$(sort $(wildcard $(S)/tests/fuzz/fuzz_*.c)))
FUZZ_MAIN ?= $(B)/tests/fuzz/main.o
$(B)/tests/fuzz/fuzz_%: $(B)/tests/fuzz/fuzz_%.o $(B)/tests/fuzz/fuzz.o $(FUZZ_MAIN) $(BENCH_COMMON) $(STATIC)
	$(CC) $(ALL_CFLAGS) $(LDFLAGS) -pthread -o $@ $^ $(LIBS)
fuzz-programs: $(FUZZ)
check: $(FUZZ)
fuzz: ## look for inputs that the library cannot stand, a minute; FUZZ_RUNS=1e7 inputs for each program, FUZZ_AFL=1e7 by AFL++
	@S='$(abspath $(S))' B='$(abspath $(B))' MAKE='$(MAKE)' sh $(S)/tests/fuzz/run
analyse: ## static analysers on the library: gcc -fanalyzer, clang-tidy, cppcheck, as far as they are here
	@python3 $(S)/tests/analyse.py
platforms: ## the quick tests with every compiler, processor and C library that is here; PLATFORMS="s390x musl" for some
	@S='$(abspath $(S))' B='$(abspath $(B))' MAKE='$(MAKE)' sh $(S)/tests/platforms/run
mutants: ## break the library in every place of tests/mutants, and see whether the tests notice: hours
	@python3 $(S)/tests/mutate.py --work $(abspath $(B))/mutants
audit: ## all of these with full counts, a day or so; what they find goes to audit/RESULTS
	@S='$(abspath $(S))' B='$(abspath $(B))' MAKE='$(MAKE)' VERSION='$(VERSION)' sh $(S)/tests/audit
-include $(wildcard $(B)/tests/fuzz/*.d)

# ---- load: many networks, large ones, large counts, many steps
.PHONY: load
LOAD := $(addprefix $(B)/tests/load/,solves contacts counts soak)
$(LOAD): %: %.o $(STATIC)
	$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $^ $(LIBS)
check: $(LOAD)
load: $(LOAD) ## a million small networks, two that fill the memory, counts beyond 2^31, a million steps: some twenty minutes
	@B='$(abspath $(B))' sh $(S)/tests/load/run
-include $(wildcard $(B)/tests/load/*.d)

stress: $(B)/tests/test_stress ## the solver on its whole grid of scenes, with a table; a few minutes
	@NLC_TEST_FULL=1 $(EMULATOR) $<

setup-examples: ## install LAMMPS and its library for nlc-lammps
	@sh $(S)/examples/lammps/setup

setup: ## install what the tests need with the system's package manager
	@sh $(S)/tests/setup
setup-plots: ## install gnuplot, for make plots
	@sh $(S)/tests/setup plots

# ---- installation
# Folders whose names make and the shell would take apart, or that mean another one wherever they are used, are refused.
ifneq ($(filter install uninstall,$(MAKECMDGOALS)),)
$(foreach v,DESTDIR prefix exec_prefix includedir libdir mandir pkgconfigdir cmakedir,\
    $(if $(word 2,$($v)),$(error $v=$($v): folders with spaces are not supported)))
$(foreach v,prefix exec_prefix includedir libdir mandir pkgconfigdir cmakedir,\
    $(if $(filter /%,$($v)),,$(error $v=$($v): has to begin with /)))
endif
install: lib $(PC) $(CMAKE) ## install header, Fortran module, libraries, man pages, files for pkg-config and CMake
	$(INSTALL) -d $(DESTDIR)$(includedir) $(DESTDIR)$(libdir) $(DESTDIR)$(pkgconfigdir) $(DESTDIR)$(cmakedir)
	$(INSTALL) -d $(DESTDIR)$(mandir)/man3 $(DESTDIR)$(mandir)/man7
	$(INSTALL) -m 644 $(S)/include/nlcontact.h $(S)/include/nlcontact.f90 $(DESTDIR)$(includedir)/
	$(INSTALL) -m 644 $(STATIC) $(DESTDIR)$(libdir)/
	$(INSTALL) -m 755 $(SHARED) $(DESTDIR)$(libdir)/
	ln -sf $(notdir $(SHARED)) $(DESTDIR)$(libdir)/$(SONAME)
	ln -sf $(SONAME) $(DESTDIR)$(libdir)/libnlcontact.so
	$(INSTALL) -m 644 $(PC) $(DESTDIR)$(pkgconfigdir)/
	$(INSTALL) -m 644 $(CMAKE) $(DESTDIR)$(cmakedir)/
	$(INSTALL) -m 644 $(filter %.3,$(MAN)) $(DESTDIR)$(mandir)/man3/
	$(INSTALL) -m 644 $(filter %.7,$(MAN)) $(DESTDIR)$(mandir)/man7/

# What install makes, file by file; of the folders, the one that is nobody else's.
uninstall: ## remove what install put there
	rm -f $(addprefix $(DESTDIR)$(includedir)/,nlcontact.h nlcontact.f90)
	rm -f $(addprefix $(DESTDIR)$(libdir)/,$(notdir $(STATIC) $(SHARED)) $(SONAME) libnlcontact.so)
	rm -f $(DESTDIR)$(pkgconfigdir)/nlcontact.pc $(addprefix $(DESTDIR)$(cmakedir)/,$(notdir $(CMAKE)))
	rm -f $(foreach m,$(notdir $(MAN)),$(DESTDIR)$(mandir)/man$(subst .,,$(suffix $(m)))/$(m))
	rmdir $(DESTDIR)$(cmakedir) 2>/dev/null || :

DISTNAME := nlcontact-$(VERSION)
DIST_FILES = Makefile README NEWS CONTRIBUTING SECURITY COPYING CITATION.cff nlcontact.pc.in nlcontact-config.cmake.in .clang-tidy \
	nlcontact-config-version.cmake.in include lib tests bench man tools examples packaging .clang-format
RELEASED := $(shell sed -n 's/^date-released: *//p' $(S)/CITATION.cff)
dist: ## make a source archive, the same bytes every time
	@mkdir -p $(B)
	cd $(S) && tar --exclude=__pycache__ --sort=name --owner=0 --group=0 --numeric-owner --mode=u+rw,go=rX --mtime='$(RELEASED) UTC' --format=gnu \
		--transform='s|^|$(DISTNAME)/|' -cf $(abspath $(B))/$(DISTNAME).tar $(DIST_FILES)
	gzip -n -9 -f $(B)/$(DISTNAME).tar
	@echo $(B)/$(DISTNAME).tar.gz

# debian/ is not in the archive: it is what Debian adds.  The caller's variables are none of its business.
DEB := $(B)/deb/$(DISTNAME)
DEBIAN_FILES := changelog control copyright libnlcontact-dev.docs libnlcontact-dev.examples libnlcontact-dev.install \
	libnlcontact0.install libnlcontact0.symbols rules source tests watch
deb: dist ## make Debian packages, in build/deb, in a clone; with DEB_BUILD_OPTIONS=nocheck without running the tests
	@[ -d $(S)/debian ] || { echo "debian/ is in the repository, not in the archive"; exit 1; }
	rm -rf $(B)/deb
	mkdir $(B)/deb
	cp $(B)/$(DISTNAME).tar.gz $(B)/deb/$(subst -,_,$(DISTNAME)).orig.tar.gz
	tar -C $(B)/deb -xf $(B)/$(DISTNAME).tar.gz
	mkdir $(DEB)/debian
	cp -r $(addprefix $(S)/debian/,$(DEBIAN_FILES)) $(DEB)/debian
	cd $(DEB) && env -i PATH="$$PATH" HOME="$$HOME" DEB_BUILD_OPTIONS="$$DEB_BUILD_OPTIONS" dpkg-buildpackage -us -uc
	rm -rf $(DEB)

DISTCHECK := $(abspath $(B))/distcheck
# CFLAGS and the like are handed on; installation goes to the folders that are the default.
DISTCHECK_MAKE = $(MAKE) -f $(DISTCHECK)/$(DISTNAME)/Makefile B=$(DISTCHECK)/build DESTDIR=$(DISTCHECK)/stage PREFIX=/usr/local
distcheck: dist ## from the archive, unpacked elsewhere and write-protected: check, install, uninstall, the same archive again
	if [ -e $(DISTCHECK) ]; then chmod -R u+w $(DISTCHECK) && rm -rf $(DISTCHECK); fi
	mkdir $(DISTCHECK)
	gzip -dc $(B)/$(DISTNAME).tar.gz | tar -C $(DISTCHECK) -xf -
	chmod -R a-w $(DISTCHECK)/$(DISTNAME)
	cd $(DISTCHECK) && $(DISTCHECK_MAKE) check && $(DISTCHECK_MAKE) install && $(DISTCHECK_MAKE) uninstall && $(DISTCHECK_MAKE) dist
	left=$$(find $(DISTCHECK)/stage ! -type d) && [ -z "$$left" ] || { echo "uninstall leaves $$left"; exit 1; }
	cmp $(B)/$(DISTNAME).tar.gz $(DISTCHECK)/build/$(DISTNAME).tar.gz
	chmod -R u+w $(DISTCHECK) && rm -rf $(DISTCHECK)
	@echo "$(DISTNAME).tar.gz is ready to be given away"

clean: ## remove everything that was built
	rm -rf $(B)

-include $(wildcard $(B)/lib/*.d $(B)/lib/*/*.d $(B)/bench/*.d $(B)/bench/figures/*.d $(B)/bench/figures/bed/*.d $(B)/bench/hydrogel/*.d $(B)/tests/*.d)
