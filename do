#!/usr/bin/env bash
# ./do demo | test | test-long | bench [trace|dem|heat|case] [--quick]
# Each command takes a bare Debian 12 all the way: missing packages, configuration, build, run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
root=$PWD
build=$root/build/release

packages=(build-essential cmake ninja-build git python3
  libembree-dev libeigen3-dev libceres-dev libhdf5-dev libgtest-dev
  libcli11-dev libtomlplusplus-dev libfmt-dev nlohmann-json3-dev
  libudunits2-dev librandom123-dev libboost-math-dev zlib1g-dev libpugixml-dev)

# The engine on LIGGGHTS: optional in a build, part of the tests.
liggghts_engine=(libliggghts-dev libopenmpi-dev)

say() { printf '\n== %s\n' "$*"; }

usage() {
  sed -n '2,3s/^# //p' "$root/do"
  cat <<'EOF'
  demo        a plug flow of hot-walled alumina, about 1 s of flow: table, frames and a page
  test        the test suite (minutes)
  test-long   the physics that takes long
  bench       speed against error, side by side with LIGGGHTS, LAMMPS, plain Embree and dense LU;
              case: the whole moving bed of the paper beside LIGGGHTS' flow alone
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
  cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DGRANRAD_WERROR=$werror >"$root/build/configure.log" 2>&1 ||
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

case ${1:-} in
  test)
    packages+=("${liggghts_engine[@]}")
    set_up
    build all
    say "testing"
    export OMP_WAIT_POLICY=passive  # programs share the cores
    ctest --test-dir "$build" -LE long -j "$(nproc)" --output-on-failure --no-tests=error
    ;;
  test-long)
    packages+=("${liggghts_engine[@]}")
    set_up
    build all
    say "testing (long)"
    export OMP_WAIT_POLICY=passive
    ctest --test-dir "$build" -L long -j "$(nproc)" --output-on-failure --no-tests=error
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
  bench)
    shift
    which=() options=()
    for word in "$@"; do
      case $word in
        trace | dem | heat | case) which+=("$word") ;;
        --quick) options+=(--quick) ;;
        *) usage >&2; exit 2 ;;
      esac
    done
    ((${#which[@]})) || which=(trace dem heat case)
    set_up
    install_missing liggghts lammps
    for name in "${which[@]}"; do
      build "${name}_bench"
      mkdir -p "$build/bench"
      say "bench $name"
      "$build/tests/bench/${name}_bench" "${options[@]}" "$build/bench"
    done
    say "tables and figures: $build/bench"
    ;;
  -h | --help | help) usage ;;
  *) usage >&2; exit 2 ;;
esac
