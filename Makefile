# Digsight: tells an excavator what the ground will resist with. `make help` lists the targets;
# V=1 shows the commands.

PREFIX     ?= /usr/local
SYSCONFDIR ?= $(PREFIX)/etc
LIBDIR     ?= $(PREFIX)/lib
UNITDIR    ?= $(PREFIX)/lib/systemd/system
DESTDIR    ?=
BUILD      ?= build
CC         ?= cc
PKG_CONFIG ?= pkg-config
LCM_GEN    ?= lcm-gen
NVCC       ?= nvcc

VERSION    := 0.1.0

# CFLAGS belongs to whoever builds; what the code cannot do without is kept apart from it.
CFLAGS     ?= -O2 -g
STD        := -std=c11 -D_POSIX_C_SOURCE=200809L -ffp-contract=off -fno-common
WARN       := -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion \
              -Wfloat-equal -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wundef \
              -Werror=implicit-function-declaration -Wswitch-enum -Wvla -Wcast-qual -Wformat=2 -Wwrite-strings
ALL_CFLAGS  = $(STD) $(WARN) -I. -I$(BUILD) -DDIG_VERSION='"$(VERSION)"' -MMD -MP $(CFLAGS)

# Expanded only by the rules that need the library, so a missing one stops that rule and no other.
pkg_cflags  = $(shell $(PKG_CONFIG) --cflags $(1))
pkg_libs    = $(shell $(PKG_CONFIG) --libs $(1))
LIBS        = $(call pkg_libs,ode sqlite3 nlopt libmodbus lcm nettle) -lyaml -lpthread -lm

# Goals that compile nothing, or install what is missing first. Before any other, a missing library is named.
compile_nothing := setup demo test help clean format format-check layers uninstall arm64 spy deb deb-check
ifneq ($(filter-out $(compile_nothing),$(or $(MAKECMDGOALS),all)),)
missing := $(if $(shell command -v $(LCM_GEN)),,liblcm-bin) \
           $(if $(filter install,$(MAKECMDGOALS)),$(if $(shell command -v help2man),,help2man)) \
           $(shell PKG_CONFIG='$(PKG_CONFIG)' scripts/missing_packages.sh build \
                   $(if $(filter check% coverage,$(MAKECMDGOALS)),test))
ifneq ($(strip $(missing)),)
$(error These Debian packages are missing: $(strip $(missing)). `scripts/setup.sh build test` installs them)
endif
endif

Q   := $(if $(filter 1,$(V)),,@)
say  = @printf '  %-6s %s\n' $(1) $(2)

# A program's main is the one source of its folder that has the program's name.
modules   := closed_loop firmware_host offline_dem estimator tables files core
src        = $(filter-out firmware_host/digsightd.c,$(wildcard $(1)/*.c $(1)/*/*.c))
rig_src   := $(filter-out tools/rig/digrig.c,$(wildcard tools/rig/*.c tools/rig/*/*.c))
tool_src  := $(wildcard tools/*.c)
# The rest of a program too large for one file: tools/NAME/*.c belongs to tools/NAME.c.
tool_parts := $(foreach t,$(tool_src),$(wildcard $(t:.c=)/*.c))
# tests/FOLDER/test_x.c tests FOLDER's x. What stands beside it is a fixture, linked into that folder's tests;
# what stands in tests/ itself is a library for all.
test_src  := $(wildcard tests/*/test_*.c)
testlib   := $(wildcard tests/*.c)
messages  := $(patsubst messages/%.lcm,%,$(wildcard messages/*.lcm))
system_tests := $(wildcard tests/system/*.sh)
helpers   := $(patsubst tests/system/%.c,$(BUILD)/tests/system/%,$(wildcard tests/system/*.c)) \
             $(BUILD)/tests/simclock/simclock $(BUILD)/tests/simclock/preload.so
# Tests whose subject runs threads.
threaded_tests := $(shell grep -lE 'pthread|modbus_client\.h' tests/*/test_*.c)
threaded       := firmware_host estimator tables files core
JOBS      := $(shell nproc 2>/dev/null || echo 1)
all_src   := $(foreach m,$(modules),$(call src,$(m))) $(rig_src) $(tool_src) $(tool_parts) \
             $(wildcard firmware_host/digsightd.c tools/rig/digrig.c)

objs       = $(patsubst %.c,$(BUILD)/%.o,$(1))
libs      := $(BUILD)/libdig_rig.a $(foreach m,$(modules),$(BUILD)/libdig_$(m).a) \
             $(BUILD)/libdig_messages.a
bins      := $(patsubst tools/%.c,$(BUILD)/bin/%,$(tool_src)) \
             $(if $(wildcard tools/rig/digrig.c),$(BUILD)/bin/digrig) \
             $(if $(wildcard firmware_host/digsightd.c),$(BUILD)/bin/digsightd)
# What is built and run; a target may ask for fewer.
tested    := $(test_src)
test_bins  = $(patsubst tests/%.c,$(BUILD)/tests/%,$(tested))
msg_c     := $(patsubst %,$(BUILD)/messages/digsight_%.c,$(messages))
msg_h     := $(msg_c:.c=.h)

.DELETE_ON_ERROR:
.PHONY: all setup bench demo tables evaluate paper picture floors test bench-blind bench-product bench-ablation check check-unit check-asan check-tsan check-valgrind fuzz torture coverage lint lint-compiler lint-tidy lint-tidy-upper lint-tidy-lower layers docs-check \
        format format-check install uninstall clean help jar spy

all: $(bins) ## Build everything that is installed

demo: ## Set up what is missing, build, and run the main job end to end (about 4 minutes)
	$(Q)scripts/setup.sh build demo
	$(Q)$(MAKE) --no-print-directory -j $(JOBS) all
	$(Q)BIN=$(BUILD)/bin OUT=$(BUILD)/demo scripts/demo.sh

test: ## Set up what is missing, build, and run every test
	$(Q)scripts/setup.sh build test
	$(Q)$(MAKE) --no-print-directory -j $(JOBS) check

# Each by the engine it was begun with, or all with ENGINE=cuda on a graphics card.
tables: all ## Compute what the tables that ship lack of their grids (many hours of all cores; ENGINE=cuda)
	$(Q)for table in product:single product_effects:single reference_rig:kernel reference_rig_effects:kernel; do \
	    engine=$${table#*:} table=$${table%:*}; scene=$${table#reference_}; scene=$${scene%_effects}; \
	    $(BUILD)/bin/digtable generate config/scenes/$$scene.yaml config/grids/$$table.yaml \
	        -o tables/$$table.sqlite --engine $(or $(ENGINE),$$engine) || exit 1; \
	    $(BUILD)/bin/digtable check tables/$$table.sqlite || exit 1; done

evaluate: all ## How right tables/reference_rig.sqlite is on digs of LIGGGHTS
	$(Q)BIN=$(BUILD)/bin scripts/evaluate.sh
	$(Q)BIN=$(BUILD)/bin scripts/offgrid.sh

.PHONY: release-check
release-check: all ## Measure again what README and docs/accuracy.md quote, fail where it differs (minutes; RELEASE=all: hours)
	$(Q)scripts/release_check.py $(if $(filter all,$(RELEASE)),--all)

paper: all $(BUILD)/tests/paper/paper ## The paper's findings, tested on the rig table: numbers and plots
	$(Q)BIN=$(BUILD)/bin PAPER=$(BUILD)/tests/paper/paper scripts/paper.sh

picture: all floors ## Pictures of README and tutorial, a predicted dig against the measured one, and those of the floors
	$(Q)BIN=$(BUILD)/bin scripts/picture.sh docs/pictures/predicted.svg
	$(Q)BIN=$(BUILD)/bin scripts/tutorial_picture.sh docs/pictures/tutorial.svg

floors: ## The pictures of docs/architecture.md, drawn from scripts/check_layers.sh and the tree
	$(Q)scripts/floors.sh docs/pictures

setup: ## Install everything any target needs
	$(Q)scripts/setup.sh build demo test lint spy valgrind

$(msg_c) $(msg_h): $(BUILD)/messages/.made ;
$(BUILD)/messages/.made: $(wildcard messages/*.lcm)
	$(call say,LCM,messages)
	$(Q)mkdir -p $(@D) && $(LCM_GEN) -c --c-cpath $(@D) --c-hpath $(@D) $^ && touch $@

$(BUILD)/libdig_rig.a: $(call objs,$(rig_src))
$(BUILD)/libdig_messages.a: $(msg_c:.c=.o)
$(BUILD)/tests/libtests.a: $(call objs,$(testlib))
$(foreach m,$(modules),$(eval $(BUILD)/libdig_$(m).a: $(call objs,$(call src,$(m)))))

$(BUILD)/%.a:
	$(call say,AR,$@)
	$(Q)mkdir -p $(@D) && rm -f $@ && $(AR) rcs $@ $^

# Generated by lcm-gen: not ours to warn about.
$(BUILD)/messages/%.o: $(BUILD)/messages/%.c
	$(call say,CC,$<)
	$(Q)$(CC) -std=gnu11 -w $(CFLAGS) $(GENERATED) $(CPPFLAGS) $(call pkg_cflags,lcm) -I$(BUILD)/messages -c $< -o $@

$(BUILD)/%.o: %.c | $(BUILD)/messages/.made
	$(call say,CC,$<)
	$(Q)mkdir -p $(@D) && $(CC) $(ALL_CFLAGS) $(CPPFLAGS) -c $< -o $@

foreign = $(foreach d,$(call pkg_cflags,$(1)),$(patsubst -I%,-isystem %,$(d)))
$(BUILD)/offline_dem/%.o:   CPPFLAGS += $(call foreign,ode)
# The grain kernel is picked at run time for the processor it finds; this is what its loops need.
$(BUILD)/offline_dem/%.o:   CPPFLAGS += -fopenmp-simd -fno-math-errno -fno-trapping-math
# What is fitted to digs is loops over thirty numbers, which are taken several at once so; the bits are the same.
$(BUILD)/closed_loop/%.o:   CFLAGS += -O3
# No one asks errno after a square root; without it the loop over the points of a curve is vectorised.
$(BUILD)/estimator/match/likelihood.o: CPPFLAGS += -fno-math-errno
# What the numbers of a dig depend on, told apart in every run of a table.
numerics_src := $(filter-out offline_dem/dig/vtk.% offline_dem/dig/checked_pour.%,$(wildcard $(foreach r,law shapes kernel world dig,offline_dem/$r/*.[ch])) \
                $(filter-out %_cuda.c %_cuda.h,$(wildcard offline_dem/device/*.[ch])) $(wildcard offline_dem/cuda/*.cu)) $(wildcard core/scene*.[ch] core/contact.[ch] core/curve.[ch] core/chance.[ch] core/units.h)
numerics      = $(shell { cat $(sort $(numerics_src)); echo '$(CC) $(STD) $(CFLAGS)'; $(CC) -dumpfullversion -dumpmachine; } \
                | sha256sum | cut -c1-12)
$(BUILD)/offline_dem/sweep/sweep.o: CPPFLAGS += -DDIG_NUMERICS='"$(numerics)"'
$(BUILD)/offline_dem/sweep/sweep.o: $(numerics_src)
$(BUILD)/tables/%.o:        CPPFLAGS += $(call foreign,sqlite3)
$(BUILD)/files/%.o:         CPPFLAGS += $(call foreign,lcm)
$(BUILD)/firmware_host/%.o: CPPFLAGS += $(call foreign,lcm libmodbus)
$(BUILD)/tools/rig/%.o:     CPPFLAGS += $(call foreign,libmodbus)
$(BUILD)/tools/digwatch/%.o: CPPFLAGS += $(call foreign,lcm)
$(BUILD)/tests/%.o:         CPPFLAGS += $(call foreign,cmocka lcm libmodbus sqlite3 ode) $(TEST_CFLAGS)
# What is run once need not be optimised as what ships: a third of the time to compile it.
$(call objs,$(test_src)):   CPPFLAGS += $(or $(TEST_CFLAGS),-O1)
# What sanitizers need not look for in the wings that compute.
$(BUILD)/estimator/%.o $(BUILD)/offline_dem/%.o $(BUILD)/closed_loop/%.o: CPPFLAGS += $(NUMERIC_CFLAGS)

$(BUILD)/bin/digsightd: $(BUILD)/firmware_host/digsightd.o
$(BUILD)/bin/digrig:    $(BUILD)/tools/rig/digrig.o
$(patsubst tools/%.c,$(BUILD)/bin/%,$(tool_src)): $(BUILD)/bin/%: $(BUILD)/tools/%.o
$(foreach t,$(tool_parts),$(eval $(BUILD)/bin/$(notdir $(patsubst %/,%,$(dir $(t)))): $(call objs,$(t))))

$(BUILD)/bin/digwatch:  LIBS += $(call pkg_libs,ncursesw)

# Static libraries are searched in order; the group lets the order be alphabetical.
link = $(CC) $(CFLAGS) $(LDFLAGS) $(filter %.o,$^) -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(1) -o $@

$(BUILD)/bin/%: $(libs)
	$(call say,LD,$@)
	$(Q)mkdir -p $(@D) && $(call link,$(LIBS))

.SECONDEXPANSION:
fixtures = $(call objs,$(filter-out $(test_src) tests/blind/blind.c,$(wildcard tests/$(1)/*.c)))
$(patsubst %.c,$(BUILD)/%,$(test_src)): %: %.o $(BUILD)/tests/libtests.a $$(call fixtures,$$(notdir $$(@D))) $(libs)
	$(call say,LD,$@)
	$(Q)$(call link,$(call pkg_libs,cmocka) $(LIBS))

# tests/PROGRAM/test_*.c test the parts of tools/PROGRAM.c.
$(foreach t,$(tool_parts),$(eval $(patsubst %.c,$(BUILD)/%,$(wildcard tests/$(notdir $(patsubst %/,%,$(dir $t)))/test_*.c)): $(call objs,$t)))
$(BUILD)/tests/digwatch/%: LIBS += $(call pkg_libs,ncursesw)

# What these tests count, or answer themselves, is called in its place.
comma  := ,
wrap    = $(addprefix -Wl$(comma)--wrap=,$(1))
$(BUILD)/tests/firmware_host/test_loop_calls: LDFLAGS += $(call wrap,malloc calloc realloc free aligned_alloc posix_memalign \
    pthread_mutex_lock pthread_mutex_trylock pthread_cond_wait pthread_rwlock_rdlock pthread_rwlock_wrlock sem_wait sem_post \
    printf fprintf vfprintf puts fputs fputc fwrite write)
$(BUILD)/tests/firmware_host/test_loop_overrun: LDFLAGS += $(call wrap,clock_gettime clock_nanosleep)

# Programs that only system tests need.
$(BUILD)/tests/system/%: $(BUILD)/tests/system/%.o $(libs)
	$(call say,LD,$@)
	$(Q)$(call link,$(LIBS))

# The clock of the programs that system tests run.
$(BUILD)/tests/simclock/simclock: $(BUILD)/tests/simclock/simclock.o
	$(call say,LD,$@)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) $^ -o $@
$(BUILD)/tests/simclock/preload.o: CPPFLAGS += -fPIC
$(BUILD)/tests/simclock/preload.so: $(BUILD)/tests/simclock/preload.o
	$(call say,LD,$@)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -shared $^ -o $@ -ldl

# One more at a time than there are cores: some wait for a program that waits.
check: $(test_bins) $(helpers) all jar ## Build and run every test (what `make test` does once all is installed)
	$(Q)BIN=$(BUILD)/bin scripts/run_tests.sh -j $$(($(JOBS) + 1)) $(system_tests) $(test_bins)

check-unit: $(test_bins) ## The unit tests alone
	$(Q)scripts/run_tests.sh -j $(JOBS) $(test_bins)

# Under a sanitizer, what lcm-gen makes takes eight times as long to optimise as to compile, a test twice as long, and
# gold links twice as fast.
sanitized = DIG_TEST_QUICK=1 GENERATED=-O0 TEST_CFLAGS=-O0 \
            LDFLAGS='$(LDFLAGS) $(if $(shell command -v ld.gold),-fuse-ld=gold)' $(MAKE) check-unit
ASAN_FLAGS := -O1 -g1 -DDIG_KERNEL_BASE -fsanitize=address,undefined -fno-sanitize-recover=all
# Where numbers are computed, two checks of pointers are nearly half of the time. AddressSanitizer stops where such a
# pointer is used; what reads from outside keeps them.
ASAN_NUMERIC := -fno-sanitize=null,pointer-overflow
# Tests that repeat, for statistics or in larger beds, what smaller ones do once: minutes under a sanitizer, for nothing new.
statistics := $(foreach t,approaches_shipped coverage design_shipped effect_noise_shipped \
                few_packings lateness_shipped layers_shipped noise_shipped pour rig_track round_trip search slump small_digs,$(wildcard tests/*/test_$(t).c))
check-asan: ## The unit tests under AddressSanitizer and UBSan
	+$(Q)$(sanitized) BUILD=$(BUILD)/asan tested="$(filter-out $(statistics),$(test_src))" \
	    CFLAGS="$(ASAN_FLAGS)" NUMERIC_CFLAGS="$(ASAN_NUMERIC)"

check-tsan: ## The threaded units under ThreadSanitizer, built with what they include
	+$(Q)$(sanitized) BUILD=$(BUILD)/tsan tested="$(threaded_tests)" modules="$(threaded)" \
	    CFLAGS="-O1 -g1 -fsanitize=thread"

check-valgrind: $(test_bins) ## The unit tests under memcheck
	$(Q)scripts/setup.sh valgrind
	$(Q)for t in $(test_bins); do echo "$$t"; \
	    DIG_TEST_QUICK=1 valgrind -q --child-silent-after-fork=yes --leak-check=full --error-exitcode=1 ./$$t || exit 1; done

# What does not end when something is taken away or goes wrong, seconds or hours long: TORTURE_S for each script.
TORTURE_S    ?= 30
torture_made := $(patsubst tests/torture/%.c,$(BUILD)/tests/torture/%.so,$(wildcard tests/torture/fail_*.c)) \
                $(patsubst tests/torture/%.c,$(BUILD)/tests/torture/%,$(filter-out tests/torture/fail_%,$(wildcard tests/torture/*.c)))
torture: all $(helpers) $(torture_made) ## kill -9, full disks, no memory, lying buses, floods, TORTURE_S seconds each; counts at the end
	$(Q)BIN=$(BUILD)/bin TORTURE_S=$(TORTURE_S) scripts/torture.sh $(or $(TORTURE_ONLY),$(sort $(wildcard tests/torture/*.sh)))

$(BUILD)/tests/torture/%.so: tests/torture/%.c
	$(call say,CC,$<)
	$(Q)mkdir -p $(@D) && $(CC) -std=gnu11 -O2 -fPIC -shared $< -o $@ -ldl
.PHONY: flips mends
mends: all ## What keeps hostile input out, taken out one at a time: each time its test fails
	$(Q)scripts/mends.sh

FLIPS ?= 1000
flips: $(BUILD)/tests/torture/flips ## FLIPS bits of every shipped table flipped, one at a time: refused, or nothing changes
	$(Q)for t in tables/*.sqlite; do $(BUILD)/tests/torture/flips $$t $(FLIPS) $(FLIPS_SEED) || exit 1; done

$(BUILD)/tests/torture/%: $(BUILD)/tests/torture/%.o $(libs)
	$(call say,LD,$@)
	$(Q)$(call link,$(LIBS))

# libFuzzer is clang's. FUZZ_TARGETS: some of the files of tests/fuzz.
FUZZ_SECONDS ?= 60
FUZZ_TARGETS ?= $(patsubst tests/fuzz/%.c,%,$(wildcard tests/fuzz/*.c))
FUZZ_FLAGS   := -O1 -g -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
fuzz: ## Inputs that libFuzzer leads by coverage against every reader, under sanitizers, FUZZ_SECONDS of processor time each
	$(Q)scripts/setup.sh fuzz
	$(Q)$(MAKE) --no-print-directory $(FUZZ_TARGETS:%=$(BUILD)/libfuzzer/tests/fuzz/%) \
	    BUILD=$(BUILD)/libfuzzer CC=clang WARN=-w CFLAGS="$(FUZZ_FLAGS)"
	$(Q)FUZZERS=$(BUILD)/libfuzzer/tests/fuzz CORPORA=$(BUILD)/fuzz-corpora \
	    scripts/fuzz.sh $(FUZZ_SECONDS) $(FUZZ_TARGETS)
$(BUILD)/tests/fuzz/%: LDFLAGS += -fsanitize=fuzzer
$(BUILD)/tests/fuzz/%: $(BUILD)/tests/fuzz/%.o $(libs)
	$(call say,LD,$@)
	$(Q)$(call link,$(LIBS))

$(BUILD)/tests/paper/paper: $(call objs,$(wildcard tests/paper/*.c)) $(libs)
	$(call say,LD,$@)
	$(Q)$(call link,$(LIBS))

.PHONY: arm64 cuda deb deb-check
# No multiply is fused with an add: the card's bits are the processor's. native: for the card of this machine.
NVCCFLAGS  ?= -O3 -arch=native
cuda: $(BUILD)/libdig_cuda.so ## The library of `--engine cuda`, with NVIDIA's nvcc
$(BUILD)/libdig_cuda.so: offline_dem/cuda/card.cu $(wildcard offline_dem/*/*.h core/*.h)
	$(call say,NVCC,$@)
	$(Q)mkdir -p $(@D) && $(NVCC) -std=c++20 -fmad=false $(NVCCFLAGS) -Xcompiler -fPIC -shared -I. $< -o $@

arm64: ## Cross-build for 64-bit ARM and run the unit tests under qemu-user
	$(Q)BUILD=$(BUILD)/arm64 scripts/arm64.sh

deb: ## Debian packages: controller, workstation, data of both, development, in $(BUILD)/deb
	$(Q)scripts/setup.sh build deb
	$(Q)BUILD=$(BUILD) VERSION=$(VERSION) JOBS=$(JOBS) scripts/deb.sh

deb-check: deb ## The packages: same bytes when built again, lintian, used by an ordinary user in a bare Debian root (root, network)
	$(Q)scripts/setup.sh deb-check
	$(Q)BUILD=$(BUILD) VERSION=$(VERSION) JOBS=$(JOBS) scripts/deb_check.sh $(DEB_ROOT)

bench: all $(patsubst %.c,$(BUILD)/%,$(wildcard tests/bench/*.c)) ## Side by side with others, one line each: name ratio unit detail (BENCH_QUICK=1: seconds of it)
	$(Q)scripts/setup.sh bench
	$(Q)BUILD=$(BUILD) scripts/bench.sh

$(BUILD)/tests/bench/%: $(BUILD)/tests/bench/%.o $(libs)
	$(call say,LD,$@)
	$(Q)$(call link,$(LIBS))

# Another machine, other formulas: what digloop trace is judged by. BLIND_N campaigns without an
# effect and, in proportion, those with one; BLIND_ARGS: see tests/blind/README.md.
BLIND_N     ?= 1000
BLIND_TABLE ?= tables/reference_rig.sqlite
blind_objs  := $(call objs,$(filter-out $(test_src),$(wildcard tests/blind/*.c)))
blind       := $(BUILD)/tests/blind/blind --bin $(BUILD)/bin --split judge
bench-blind bench-product: $(BUILD)/tests/blind/blind $(BUILD)/bin/digloop $(BUILD)/bin/digrig
bench-blind: ## How often digloop trace is right, on campaigns it never saw
	$(Q)mkdir -p $(BUILD)/blind
	$(Q)$(blind) --table $(BLIND_TABLE) --cache $(BUILD)/blind -n $(BLIND_N) -j $(JOBS) --json $(BUILD)/blind.json $(BLIND_ARGS)

bench-product: ## The same in the open, by tables/product.sqlite (BLIND_N=80: five minutes of two cores)
	$(Q)mkdir -p $(BUILD)/blind_product
	$(Q)$(blind) --table tables/product.sqlite --scene config/scenes/product.yaml --data tests/data/product \
	    --cache $(BUILD)/blind_product -n $(BLIND_N) -j $(JOBS) --json $(BUILD)/blind_product.json $(BLIND_ARGS)

bench-ablation: $(BUILD)/tests/blind/blind ## What each rule of the closed loop is worth, on the split for development (ABLATION_N=20)
	$(Q)mkdir -p $(BUILD)/blind
	$(Q)JOBS=$(JOBS) scripts/ablation.sh $(or $(ABLATION_N),20)

$(BUILD)/tests/blind/blind: $(blind_objs) $(libs)
	$(call say,LD,$@)
	$(Q)$(call link,$(LIBS))

coverage: ## Line and branch coverage per source file
	$(Q)DIG_TEST_QUICK=1 $(MAKE) check-unit BUILD=$(BUILD)/cov CFLAGS="-O0 -g --coverage"
	$(Q)gcov -b -r -n $$(find $(BUILD)/cov -name '*.gcda' -not -path '*/tests/*' -not -path '*/messages/*')

# The analyzer reads what ships; tests are run under sanitizers instead. What no other step of continuous integration
# compiles must not fall behind what it tests.
seldom_src := $(wildcard tests/fuzz/*.c tests/torture/*.c)
lint: lint-compiler lint-tidy ## Layering, documents, the compiler's analyzer, clang-tidy
lint-compiler: layers docs-check $(BUILD)/messages/.made
	$(Q)printf '%s\n' $(all_src) | xargs -P $(JOBS) -I{} \
	    $(CC) $(STD) $(WARN) -Werror -O1 -fanalyzer $(lint_flags) -c {} -o /dev/null
	$(Q)printf '%s\n' $(seldom_src) | xargs -P $(JOBS) -I{} $(CC) $(STD) $(WARN) -Werror $(lint_flags) -fsyntax-only {}
# A third of the nodes that clang's analyzer may visit in a function, twice what any of its findings here took; a
# function whose loops it cannot end costs a second instead of three.
tidy_flags := $(foreach word,-analyzer-config max-nodes=75000,--extra-arg=-Xclang --extra-arg=$(word))
lint-tidy: lint-tidy-upper lint-tidy-lower
lint-tidy-upper: tidy_src = $(filter closed_loop/% firmware_host/%,$(all_src))
lint-tidy-lower: tidy_src = $(filter-out closed_loop/% firmware_host/%,$(all_src))
# A file a process: in the second of several the analyzer takes every va_list for one that was not begun.
lint-tidy-upper lint-tidy-lower: $(BUILD)/messages/.made
	$(Q)printf '%s\n' $(tidy_src) | xargs -P $(JOBS) -I{} \
	    clang-tidy --quiet $(tidy_flags) {} -- $(STD) $(lint_flags) 2>/dev/null

layers: all ## Fail on an include or a circle of calls that points the wrong way
	$(Q)./scripts/check_layers.sh $(BUILD)

docs-check: ## Fail where a document names a file, heading, test, target or figure that is not there
	$(Q)./scripts/check_docs.sh

format: ## Rewrite the sources with clang-format
	$(Q)clang-format -i $$(git ls-files '*.[ch]')

format-check: ## Fail on a source clang-format would change
	$(Q)clang-format --dry-run --Werror $$(git ls-files '*.[ch]')

install_sh = PREFIX='$(PREFIX)' SYSCONFDIR='$(SYSCONFDIR)' LIBDIR='$(LIBDIR)' UNITDIR='$(UNITDIR)' \
             DESTDIR='$(DESTDIR)' BUILD='$(BUILD)' VERSION=$(VERSION) scripts/install.sh
install: all $(BUILD)/man/.made ## Install under $(DESTDIR)$(PREFIX), the daemon's configuration under $(SYSCONFDIR)
	$(Q)$(install_sh) install $(bins)

uninstall: ## Remove what install put there, but for a configuration that was changed
	$(Q)$(install_sh) uninstall $(bins)

$(BUILD)/man/.made: $(bins) scripts/man_pages.sh
	$(call say,MAN,$(@D))
	$(Q)rm -rf $(@D) && scripts/man_pages.sh $(@D) $(bins) && touch $@

lint_flags = -I. -I$(BUILD) -DDIG_VERSION='"$(VERSION)"' -DDIG_NUMERICS='"lint"' -DDIG_KERNEL_BASE -fopenmp-simd \
             $(call foreign,ode sqlite3 nlopt lcm libmodbus nettle)

clean: ## Remove the build folder
	$(Q)rm -rf $(BUILD)

help: ## This list
	@awk -F ':.*## ' '/^[a-z0-9-]+:.*## / { printf "  %-15s %s\n", $$1, $$2 }' Makefile messages/java.mk

.SECONDARY:
-include messages/java.mk
-include $(shell find $(BUILD) -name '*.d' -type f -not -path '*/arm64-root/*' 2>/dev/null)
