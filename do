#!/usr/bin/env bash
# ./do demo | test | test-long | paper [--quick] | validate [--quick] | gates | tidy | format | docs | package |
#      bench [trace|dem|heat|case|front|scale|replicas|load|forecast] [--quick | --full]
# Each command takes a bare Debian 12 all the way: missing packages, configuration, build, run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
root=$PWD
build=$root/build/release

packages=(build-essential cmake ninja-build git python3
  libembree-dev libeigen3-dev libceres-dev libhdf5-dev libgtest-dev
  libcli11-dev libtomlplusplus-dev libfmt-dev nlohmann-json3-dev
  libpng-dev libudunits2-dev librandom123-dev libboost-dev libboost-math-dev libmuparser-dev zlib1g-dev libzip-dev libpugixml-dev)

# Several processes on one case, and the engine on LIGGGHTS: optional in a build, part of the tests.
liggghts_engine=(libliggghts-dev libopenmpi-dev openmpi-bin)

# What tests look into HDF5 files with.
test_tools=(hdf5-tools)

# Python package and its tests; pages in a browser; documents; films.
python=(python3-dev pybind11-dev python3-numpy python3-scipy python3-h5py python3-pytest python3-pandas python3-jsonschema)
pages=(chromium ffmpeg)
documents=(mkdocs help2man)
workflows=(snakemake)  # what runs the Snakefile of a study
packaging=(dpkg-dev file)

settings=()  # of the configuration

say() { printf '\n== %s\n' "$*"; }

usage() {
  sed -n '2,4s/^# //p' "$root/do"
  cat <<'EOF'
  demo        a plug flow of hot-walled alumina, about 1 s of flow: table, frames and a page
  fuzz [N]    N random scenes (100) against what must hold whatever they are; failures are made small and kept; a run
              is killed at random moments and resumed
  test        the test suite (minutes)
  test-long   the physics that takes long
  gates       layout of the sources, headers alone
  sanitize    unit tests under the address and undefined-behaviour sanitizers
  tidy        clang-tidy on all sources (long), on those named, or --fast: on what everything else rests on
  format      lays the sources out
  docs        references made from the programs, and the pages as a site in build/site
  package     in build/Package a .deb of programs, library, Python, data and documents; two of the plug-ins with MPI and LIGGGHTS
  package-test
              installs that package on a bare Debian (debootstrap) and tries what README promises
  fuzz-files [SECONDS]
              damaged files of each kind that is read, SECONDS each (default 60): 0 findings is the aim
  paper       every number of the paper beside ours: out/paper/paper.html (resumable; --quick: minutes)
  validate    the validation book: docs/validation.md (resumable; --quick: what is fast)
  bench       speed against error, side by side with LIGGGHTS, LAMMPS, plain Embree and dense LU;
              case: the whole moving bed of the paper beside LIGGGHTS' flow alone;
              front: every exchange source with a ladder of rays (--quick: 3 min; --full: four emissivities);
              scale: the parts of a run on one and two ranks, and a model of more (--full: a million spheres);
              replicas: time and memory of large settled beds (--full: ten million spheres, 22 GB);
              forecast: what granrun check foresees beside what a run takes
  hard-cases  makes docs/hard-cases.md: every exchange source on the cases that break others
EOF
}

install_missing() {
  local missing=() package
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  say "installing ${missing[*]}"
  local as_root=()
  ((EUID == 0)) || as_root=(sudo)
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
}

configure() {
  say "configuring in build/release"
  local werror=OFF
  [[ ${CI:-} == true ]] && werror=ON
  cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DGRANRAD_WERROR=$werror "${settings[@]}" >"$root/build/configure.log" 2>&1 ||
    { cat "$root/build/configure.log" >&2; exit 1; }
}

build() {
  say "building $*"
  cmake --build "$build" --target "$@"
}

set_up() {
  mkdir -p "$root/build"
  install_missing "${packages[@]}"
  configure
}

sources() { git -C "$root" ls-files '*.h' '*.cpp' '*.inc'; }

case ${1:-} in
  gates)
    packages+=(clang-format-14)
    set_up
    say "layout"
    (cd "$root" && sources | xargs clang-format-14 --dry-run -Werror) ||
      { echo "some sources are laid out differently; ./do format mends them" >&2; exit 1; }
    say "headers alone"
    cmake --build "$build" --target header_check
    ;;
  sanitize)
    packages+=("${test_tools[@]}")
    set_up
    shift
    libraries='[a-z]+'
    [[ ${1:-} == --fast ]] && libraries='(base|files|toml|bed|mesh|scene|dem)'
    say "unit tests under sanitizers"
    cmake --preset Sanitize -S "$root" >"$root/build/sanitize.log" 2>&1 || { cat "$root/build/sanitize.log" >&2; exit 1; }
    mapfile -t unit < <(cd "$root/tests" && sed -nE "s/^granrad_test\\(unit\\/([a-z0-9_]+) granrad_$libraries[ )].*/test_unit_\\1/p" ./*.cmake)
    cmake --build "$root/build/Sanitize" --target "${unit[@]}"
    export LSAN_OPTIONS="suppressions=$root/tests/leaks_of_libraries.txt:print_suppressions=0"
    printf '%s\n' "${unit[@]}" | xargs -P "$(nproc)" -I{} env OMP_WAIT_POLICY=passive "$root/build/Sanitize/tests/{}" --gtest_brief=1
    ;;
  tidy)
    packages+=(clang-tidy-14)
    set_up
    shift
    files=("$@")
    if [[ ${1:-} == --fast ]]; then  # what everything else rests on
      build granrad_heat >/dev/null
      mapfile -t files < <(sources | grep -E '^(dem/(base|bed|cover)|coupling/heat)/.*\.cpp$')
    else
      build all >/dev/null  # sources that the build makes
      ((${#files[@]})) || mapfile -t files < <(sources | grep '\.cpp$' | grep -v '^tests/bench')
    fi
    say "clang-tidy on ${#files[@]} sources"
    printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 4 clang-tidy-14 -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option
    ;;
  package)
    packages+=("${liggghts_engine[@]}" "${python[@]}" "${documents[@]}" "${packaging[@]}")
    mkdir -p "$root/build"
    install_missing "${packages[@]}"
    say "package"
    rm -f "$root"/build/Package/granrad*.deb
    cmake -S "$root" --preset Package >"$root/build/package.log" 2>&1 || { cat "$root/build/package.log" >&2; exit 1; }
    cmake --build "$root/build/Package"
    (cd "$root/build/Package" && cpack -G DEB)
    ls -l "$root"/build/Package/*.deb
    ;;
  package-test)
    packages=(debootstrap)
    install_missing "${packages[@]}"
    [[ -n $(ls "$root"/build/Package/granrad*.deb 2>/dev/null) ]] || "$root/do" package
    say "the package alone on a bare Debian"
    "$root/packaging/try_package.sh" "$root"/build/Package
    ;;
  docs)
    packages+=("${documents[@]}")
    set_up
    build granrun vfgen
    "$root/docs/make_references.sh" "$build/bin"
    (cd "$root" && mkdocs build --quiet --strict --config-file docs/mkdocs.yml --site-dir "$root/build/site")
    say "site: $root/build/site/index.html"
    ;;
  format)
    install_missing clang-format-14
    sources | xargs clang-format-14 -i
    ;;
  test)
    packages+=("${liggghts_engine[@]}" "${test_tools[@]}" "${pages[@]}" "${python[@]}")
    settings+=(-DGRANRAD_PYTHON=ON)
    set_up
    build all
    say "testing"
    export OMP_WAIT_POLICY=passive  # programs share the cores
    ctest --test-dir "$build" -LE long -j "$(nproc)" --output-on-failure --no-tests=error
    ;;
  test-long)
    packages+=("${liggghts_engine[@]}" "${test_tools[@]}" "${workflows[@]}")
    set_up
    build all
    say "testing (long)"
    export OMP_WAIT_POLICY=passive
    ctest --test-dir "$build" -L long -j "$(nproc)" --output-on-failure --no-tests=error
    ;;
  fuzz)
    set_up
    build granrun judge_runner
    "$root/tests/judge/kills.py" "$build/bin/granrun" --count 10
    "$root/tests/judge/judge.py" "$build/tests/judge_runner" "$build/bin/granrun" --count "${2:-100}" --first "${3:-1}" \
      --jobs "$(nproc)" --keep "$build/judge"
    ;;
  demo)
    set_up
    build granrun vfgen
    out=$root/out/demo
    say "a plug flow of alumina between two walls at 1000 K"
    rm -rf "$out"
    "$build/bin/granrun" check data/scenes/demo.toml
    "$build/bin/granrun" run data/scenes/demo.toml -o "$out"
    "$build/bin/granrun" report "$out"
    say "done"
    cat <<EOF
  page      $out/report.html        open it in a browser
  history   $out/history.csv        one row per output; any spreadsheet, or pandas.read_csv
  frames    $out/run.hdf.series     paraview $out/run.hdf.series
            $out/frames/*.hdf       h5py, or: $build/bin/granrun export $out --to dump   (OVITO)
EOF
    ;;
  paper | validate)
    what=$1
    [[ $what == paper ]] || packages+=("${liggghts_engine[@]}" "${test_tools[@]}")
    quick=()
    [[ ${2:-} == --quick ]] && quick=(--quick)
    set_up
    out=$root/out/$what${quick[0]:+-quick}
    if [[ $what == paper ]]; then
      build granrun vfgen
      say "the paper beside ours"
      code=0
      book=$root/docs/paper.md
      ((${#quick[@]})) && book=$out/paper.md
      "$build/bin/granrun" study data/studies/li_2024.toml -o "$out" --book "$book" "${quick[@]}" || code=$?
      [[ ! -f $out/report.html ]] || cp "$out/report.html" "$out/paper.html"
      say "page: $out/paper.html, book: $book, numbers: $out/claims.csv"
    else
      build granrun vfgen test_analytic_{extinction,view_factors,paths,heating,gas_lens} test_cli_granrun_measure \
        test_physics_{two_body,bulk_flow}
      book=$root/docs/validation.md
      ((${#quick[@]})) && book=$out/validation.md
      say "the validation book"
      mkdir -p "$out"
      code=0
      "$build/bin/granrun" study data/studies/validation.toml -o "$out" --book "$book" "${quick[@]}" || code=$?
      say "book: $book, page: $out/report.html"
    fi
    exit $code
    ;;
  bench)
    shift
    which=() options=()
    for word in "$@"; do
      case $word in
        trace | dem | heat | case | front | scale | replicas | load | forecast) which+=("$word") ;;
        --quick | --full) options=("$word") ;;
        *) usage >&2; exit 2 ;;
      esac
    done
    ((${#which[@]})) || which=(trace dem heat case front scale load forecast)
    [[ ${options[*]} != --full || ${which[*]} =~ ^(front|scale|replicas)$ ]] || { echo "--full is for front, scale and replicas" >&2; exit 2; }
    set_up
    install_missing liggghts lammps
    for name in "${which[@]}"; do
      if [[ $name == scale || $name == replicas ]]; then
        build granrun
        say "bench $name"
        /usr/bin/python3 "$root/tests/bench/$name.py" "${options[@]}" "$build/bin/granrun" "$build/bench"
        continue
      fi
      if [[ $name == load ]]; then
        build granrun
        mkdir -p "$build/bench"
        say "bench load"
        "$root/tests/bench/load_bench.py" "$build/bin/granrun" "$root/data/scenes" "$build/bench" "${options[@]}"
        continue
      fi
      mkdir -p "$build/bench"
      if [[ $name == forecast ]]; then
        build granrun
        say "bench forecast"
        /usr/bin/python3 "$root/tests/bench/forecast.py" "$build/bin/granrun" "$root/data/scenes" "$build/bench" "${options[@]}"
        continue
      fi
      build "${name}_bench"
      say "bench $name"
      "$build/tests/bench/${name}_bench" "${options[@]}" "$build/bench"
    done
    say "tables and figures: $build/bench"
    ;;
  fuzz-files)
    seconds=${2:-60}
    packages+=(clang libclang-rt-14-dev libomp-dev)
    set_up
    fuzz=$root/build/fuzz
    kinds=(scene table dump csv stl vtk xyz frame view_factors)
    say "building the fuzzers in build/fuzz"
    cmake -S "$root" -B "$fuzz" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_C_COMPILER=clang \
      -DCMAKE_CXX_COMPILER=clang++ -DGRANRAD_FUZZ=ON >"$fuzz.log" || { cat "$fuzz.log"; exit 1; }
    cmake --build "$fuzz" --target "${kinds[@]/#/fuzz_}"
    say "fuzzing ${kinds[*]}, $seconds s each, $(nproc) at a time; what is found: $fuzz/found/KIND-*"
    for kind in "${kinds[@]}"; do
      mkdir -p "$fuzz/found/$kind"
      echo "$kind"
    done | xargs -P "$(nproc)" -I{} env "$fuzz/tests/fuzz_{}" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 \
      -max_len=65536 -close_fd_mask=3 -print_final_stats=1 -artifact_prefix="$fuzz/found/{}-" "$fuzz/found/{}" \
      "$root/tests/fuzz/corpus/{}"
    say "no findings"
    ;;
  hard-cases)
    set_up
    build granrun
    /usr/bin/python3 "$root/tests/bench/hard_cases.py" "$build/bin/granrun" \
      "$root/data/correlations/granrad_hard_spheres.toml" "$root/docs/hard-cases.md" "${@:2}"
    ;;
  -h | --help | help) usage ;;
  *) usage >&2; exit 2 ;;
esac
