#!/usr/bin/env bash
# Installs the library into an empty folder and uses it from there, as another project does.
#   library_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail

build=$(realpath "$1")
source=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix

fail() { echo "library_test: $*" >&2; exit 1; }

cmake --install "$build" --prefix "$prefix" > /dev/null

# --- headers: none shows what the library is made with, and each can be included alone
internal='toml\+\+|fmt/|CLI/|alglib|gnuplot-iostream|sundials|cvode|ida/|tbb|nlohmann'
if grep -rnE "#include [<\"]($internal)" "$prefix/include/monograin"; then fail "public headers include internal ones"; fi
if grep -rnE '#include "' "$prefix/include/monograin" | grep -v '#include "monograin/'; then
  fail "public headers include others without 'monograin/'"
fi
for header in "$prefix"/include/monograin/*.hpp; do
  echo "#include <monograin/$(basename "$header")>" > "$work/alone.cpp"
  g++ -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Werror -I"$prefix/include" "$work/alone.cpp"
done
(cd "$prefix/include" && find monograin/laws -name '*.hpp') | sed 's/.*/#include <&>/' > "$work/laws.cpp"
g++ -std=c++20 -fsyntax-only -I"$prefix/include" -isystem /usr/include/eigen3 "$work/laws.cpp"

# --- libraries show their own names only: a program may have Eigen with other options
for library in $(find "$prefix" -name 'libmonograin*.so'); do
  if nm -D --defined-only "$library" | grep -v 9monograin; then fail "$library shows names of others"; fi
done

# --- find_package
cmake -S "$source/examples/cpp" -B "$work/examples" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Debug > /dev/null
cmake --build "$work/examples" > "$work/log" || { cat "$work/log"; fail "the examples do not build"; }
cd "$work"
examples/example_run_scenario | tee run.txt
grep -q '^complete: ' run.txt || fail "run_scenario"
for file in history.csv events.csv run.json; do [[ -s runs/from-cpp/$file ]] || fail "run_scenario left no $file"; done
examples/example_sweep "$source/scenarios/die.toml" | tee sweep.txt
(($(grep -c 'complete$' sweep.txt) == 9)) || fail "sweep"
examples/example_own_law | tee law.txt
grep -q '^complete, force 200 N, expected 200 N' law.txt || fail "own_law"

examples/example_calibrate "$source/scenarios/calibrate/uniaxial.toml" | tee fit.txt
grep -q '^material.yield_stress .* Pa, 95 % in \[' fit.txt || fail "calibrate"
[[ -s runs/fit-from-cpp/fitted.toml ]] || fail "calibrate left no fitted.toml"

mkdir "$work/components"
cat > "$work/components/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(components LANGUAGES CXX)
find_package(monograin 0.1 REQUIRED COMPONENTS monograin studies)
find_package(monograin 0.1 QUIET COMPONENTS figures)
if(monograin_FOUND OR NOT monograin_NOT_FOUND_MESSAGE MATCHES "figures")
  message(FATAL_ERROR "a component that is missing: ${monograin_NOT_FOUND_MESSAGE}")
endif()
END
cmake -S "$work/components" -B "$work/of-components" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" > "$work/log" 2>&1 ||
  { cat "$work/log"; fail "find_package with components"; }

# --- pkg-config
if command -v pkg-config > /dev/null; then
  export PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name monograin.pc)")
  # shellcheck disable=SC2046
  g++ -std=c++20 "$source/examples/cpp/run_scenario.cpp" -o by_pkg_config $(pkg-config --cflags --libs monograin)
  # shellcheck disable=SC2046
  g++ -std=c++20 "$source/examples/cpp/calibrate.cpp" -o fit_by_pkg_config $(pkg-config --cflags --libs monograin_studies)
  LD_LIBRARY_PATH=$(dirname "$(find "$prefix" -name 'libmonograin.so')")
  export LD_LIBRARY_PATH
  ./by_pkg_config | cmp - run.txt || fail "pkg-config"
  ./fit_by_pkg_config "$source/scenarios/calibrate/uniaxial.toml" | cmp - fit.txt || fail "pkg-config, studies"
fi

# --- the build tree as a package, and add_subdirectory: neither needs what only tests and tools are built with
cmake -S "$source/examples/cpp" -B "$work/of-build" -G Ninja -Dmonograin_DIR="$build" > /dev/null
mkdir "$work/outer"
cat > "$work/outer/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.25)
project(outer LANGUAGES CXX)
set(CMAKE_DISABLE_FIND_PACKAGE_GTest ON)
set(CMAKE_DISABLE_FIND_PACKAGE_CLI11 ON)
set(CMAKE_DISABLE_FIND_PACKAGE_ALGLIB ON)
file(TOUCH "\${CMAKE_BINARY_DIR}/empty.cpp")
add_subdirectory("$source" monograin)
add_subdirectory("$source/examples/cpp" examples)
add_library(of_outer "\${CMAKE_BINARY_DIR}/empty.cpp")
get_target_property(type of_outer TYPE)
if(NOT type STREQUAL "STATIC_LIBRARY" OR DEFINED CACHE{BUILD_SHARED_LIBS})
  message(FATAL_ERROR "a library of the outer project is a \${type} now")
endif()
if(TARGET monograin_cli OR TARGET monograin_api_tests)
  message(FATAL_ERROR "tests and tools are built")
endif()
END
cmake -S "$work/outer" -B "$work/outer-build" -G Ninja > "$work/log" || { cat "$work/log"; fail "add_subdirectory"; }

# --- the library alone, in folders of its own
cmake -S "$source" -B "$work/library-alone" -G Ninja -DMONOGRAIN_BUILD_PROGRAM=OFF -DMONOGRAIN_BUILD_TESTS=OFF \
  -DCMAKE_INSTALL_INCLUDEDIR=/opt/include -DCMAKE_INSTALL_LIBDIR=/opt/lib > "$work/log" ||
  { cat "$work/log"; fail "the library without the program"; }
grep -qx 'Cflags: -I/opt/include' "$work/library-alone/monograin.pc" || fail "absolute folders in monograin.pc"
echo "library_test: passed"
