#!/usr/bin/env bash
# Installs the program into an empty folder and uses it from another one, away from the checkout.
set -euo pipefail

usage() {
  cat <<'END'
Usage: tests/install/program_test.sh BUILD | tests/install/program_test.sh --program FILE

Installs the build in the folder BUILD, or takes the installed program FILE, and runs from an empty folder: a ready
scenario with its figure, a page of the atlas, and a scene of the bench.
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
  --program) (($# == 2)) || { usage >&2; exit 2; } ;;
  *) (($# == 1)) || { usage >&2; exit 2; } ;;
esac

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
if [[ "$1" == --program ]]; then
  program=$(realpath "$2")
else
  cmake --install "$1" --prefix "$folder/prefix" --component program > "$folder/install.log"
  program=$folder/prefix/bin/monograin
fi
data=$(dirname "$(dirname "$program")")/share/monograin

fail() {
  echo "tests/install/program_test.sh: $*" >&2
  exit 1
}

expect() {
  [[ -s "$1" ]] || fail "$1 is missing or empty"
}

mkdir "$folder/empty"
cd "$folder/empty"
unset MONOGRAIN_DATA
# The data are not changed.
before=$(cd "$data" && find . -type f -printf '%p %s %T@\n' | sort)

"$program" run "$data/scenarios/die.toml" --plot --quiet
for file in history.csv events.csv run.json figure.svg; do expect "runs/die/$file"; done

[[ $("$program" atlas --list | wc -l) -gt 30 ]] || fail "atlas --list lists too few figures"
"$program" atlas packing-1-disc
for file in svg gp dat md csv; do expect "figures/packing-1-disc.$file"; done

"$program" bench mdr-die-50 --integrator auto --rtol 1e-4
for file in bench.md bench.csv bench-mdr-die-50.svg; do expect "bench/$file"; done

# What the environment names comes first, and is told where it is wrong.
mkdir ../other
if MONOGRAIN_DATA=../other "$program" atlas --list 2> ../message; then fail "a wrong MONOGRAIN_DATA is taken"; fi
grep -q "MONOGRAIN_DATA = ../other has no 'plots'" ../message || fail "unexpected: $(cat ../message)"
cp -r "$data/plots" ../other
find ../other/plots -maxdepth 1 -name '*.toml' ! -name 'packing-1-disc.toml' -delete
[[ $(MONOGRAIN_DATA=../other "$program" atlas --list | wc -l) -eq 1 ]] || fail "MONOGRAIN_DATA is not taken"

[[ "$before" == "$(cd "$data" && find . -type f -printf '%p %s %T@\n' | sort)" ]] || fail "the installed data have changed"
