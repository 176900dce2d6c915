#!/usr/bin/env bash
# try_package.sh DEB: the package alone on a bare Debian 12: what README promises, an example against the library by CMake and
# by pkg-config, and the time from nothing to the first picture. Needs root and debootstrap; leaves nothing behind.
set -euo pipefail
deb=$(realpath "$1")
root=$(mktemp -d /tmp/granrad_root_XXXXXX)
trap 'umount "$root/proc" 2>/dev/null || true; rm -rf "$root"' EXIT
mirror=$(grep -rhoE 'https?://[^ ]+' /etc/apt/sources.list /etc/apt/sources.list.d/ 2>/dev/null | head -1)
debootstrap --variant=minbase bookworm "$root" ${mirror:+"$mirror"} >"$root.log" 2>&1 ||
  { tail -5 "$root.log"; exit 1; }
rm -f "$root.log"
cp -r /etc/apt/. "$root/etc/apt/"
cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
mount -t proc proc "$root/proc"
cp "$deb" "$root/tmp/granrad.deb"

say() { printf '== %s\n' "$*"; }
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive bash -ec "$1"; }

begin=$SECONDS
say "install"
inside 'apt-get update -q >/dev/null && apt-get install -y -q --no-install-recommends /tmp/granrad.deb >/tmp/apt.log 2>&1 || { tail -20 /tmp/apt.log; exit 1; }'
installed=$SECONDS

say "new, check, run, report, render"
inside 'cd /tmp && granrun new my.toml --from plug && granrun check my.toml >/dev/null &&
  granrun run my.toml -o out --set scene.end_time_s=0.05 --set radiation.rays=500 -q &&
  granrun report out -q && granrun render out -o bed.png -q && test -s out/report.html && test -s bed.png'
echo "from nothing to the first picture: $((SECONDS - begin)) s, of them $((installed - begin)) s to install"

say "a dump and an STL"
inside 'cd /tmp && printf "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 4\n0 4\n0 4\nITEM: ATOMS id x y z radius\n1 1 1 1 0.4\n2 2 1 1 0.4\n" >bed.dump &&
  printf "solid lid\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 4\nvertex 4 4 4\nvertex 4 0 4\nendloop\nendfacet\nendsolid lid\n" >lid.stl &&
  vfgen trace bed.dump --walls lid.stl --rays 1000 -o bed.h5 -q && vfgen export bed.h5 --to npz -q && man -w granrun >/dev/null 2>&1 || test -s bed.npz'

say "Python"
inside 'cd /tmp && python3 -c "
import granrad, scipy.sparse
case = granrad.Case(\"out\")
F = granrad.trace([[0.001]*3, [0.002]*3], 4e-4, box=[[0, 0, 0], [0.004]*3], rays=1000).F
assert F.shape == (9, 9) and abs(F[0].sum() - 1) < 1e-9
assert scipy.sparse.load_npz(\"bed.npz\").shape == (4, 4)
print(granrad.__name__, len(case.frames()), \"frames\")"'

say "find_package and pkg-config"
inside 'apt-get install -y -q --no-install-recommends g++ cmake make pkg-config >/tmp/apt.log 2>&1 || { tail -20 /tmp/apt.log; exit 1; }
  cp -r /usr/share/doc/granrad/example /tmp/example && cd /tmp/example && cmake -S . -B build >/dev/null && cmake --build build >/dev/null && ./build/two_spheres &&
  g++ two_spheres.cpp -o by_pkg_config $(pkg-config --cflags --libs granrad) && ./by_pkg_config'
say "all as promised"
