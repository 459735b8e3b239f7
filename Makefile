# make demo [MODEL=file]   the pictures and the table of the README, from nothing
# make pictures            the pictures of the README again
# make test                everything that must hold before a commit; .ci/run calls it
# make fuzz                each fuzzer for FUZZ_SECONDS (60)
# make format, make tidy   clang-format in place, clang-tidy over the tree
# make install             to PREFIX (/usr/local), DESTDIR is honoured
#
# The first four install what they need on Debian 12 (scripts/setup.sh).
FUZZ_SECONDS ?= 60
PREFIX ?= /usr/local
export FUZZ_SECONDS

.PHONY: all demo pictures test fuzz format tidy install
all:
	scripts/build.sh release

demo:
	scripts/setup.sh
	scripts/build.sh release crease_cli
	scripts/demo.py $(if $(MODEL),'$(MODEL)')

pictures:
	scripts/setup.sh
	scripts/build.sh release crease_cli
	scripts/pictures.py

test:
	scripts/setup.sh
	scripts/test.sh

fuzz:
	scripts/setup.sh
	scripts/test.sh fuzz

format:
	scripts/format.sh

tidy:
	scripts/test.sh tidy

install: all
	cmake --install build/release --prefix '$(PREFIX)'
