#!/usr/bin/env bash
# try_package.sh FOLDER [ROOT]: the packages in FOLDER alone on a bare Debian 12: what README promises, an example against the
# library by CMake and by pkg-config, each plug-in, and the time from nothing to the first picture. Needs root and debootstrap;
# leaves nothing behind. ROOT: a bare Debian made before, which is copied in place of a new one.
set -euo pipefail
folder=$(realpath "$1")
root=$(mktemp -d /tmp/granrad_root_XXXXXX)
trap 'umount "$root/proc" 2>/dev/null || true; rm -rf "$root" "$root.log"' EXIT
if [[ -n ${2:-} ]]; then
  cp -a "$2/." "$root/"
else
  # The mirror this machine uses.
  mirror=$(sed -nE 's/^(URIs:|deb (\[[^]]*\] )?) *(https?:[^ ]+).*/\3/p' /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null | head -1 || true)
  debootstrap --variant=minbase bookworm "$root" ${mirror:+"$mirror"} >"$root.log" 2>&1 || { tail -5 "$root.log"; exit 1; }
fi
rm -f "$root/etc/apt/sources.list"
cp -r /etc/apt/. "$root/etc/apt/"
cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
mount -t proc proc "$root/proc"
cp "$folder"/granrad*.deb "$root/tmp/"

say() { printf '== %s\n' "$*"; }
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive bash -eo pipefail -c "cd /tmp; $1"; }
add() { inside "apt-get install -y -q --no-install-recommends $* >/tmp/apt.log 2>&1 || { tail -20 /tmp/apt.log; exit 1; }"; }

say "install"
begin=$SECONDS
inside 'apt-get update -q >/dev/null'
add "/tmp/granrad_*.deb"
installed=$SECONDS
inside 'grep -E "newly installed|Need to get" /tmp/apt.log'

say "new, check, run, report, render"
inside 'granrun new my.toml --from plug >/dev/null; granrun check my.toml >/dev/null
  granrun run my.toml -o out --set scene.end_time_s=0.05 --set radiation.rays=500 -q
  granrun report out -q; granrun render out -o bed.png -q; test -s out/report.html; test -s bed.png'
echo "from nothing to the first picture: $((SECONDS - begin)) s, of them $((installed - begin)) s to install"

say "a dump and an STL"
inside 'printf "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 4\n0 4\n0 4\nITEM: ATOMS id x y z radius\n1 1 1 1 0.4\n2 2 1 1 0.4\n" >bed.dump
  printf "solid lid\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 4\nvertex 4 4 4\nvertex 4 0 4\nendloop\nendfacet\nendsolid lid\n" >lid.stl
  vfgen trace bed.dump --walls lid.stl --rays 1000 -o bed.h5 -q; vfgen export bed.h5 --to npz -q; test -s bed.npz'

say "the tutorials, line by line"
inside 'ln -s /usr/share/granrad data
  for page in /usr/share/doc/granrad/docs/tutorial_*.md; do
    while read -r line; do
      OMP_WAIT_POLICY=passive bash -c "$line" >step.log 2>&1 </dev/null || { echo "$page: $line"; tail -5 step.log; exit 1; }
    done < <(sed -n "/^\`\`\`sh/,/^\`\`\`/{/^\`\`\`/d;p}" "$page" | sed -E "s/  #.*//; /^ *$/d")
  done'

say "Python"
inside 'python3 -c "
import granrad, scipy.sparse
case = granrad.Case(\"out\")
F = granrad.trace([[0.001]*3, [0.002]*3], 4e-4, box=[[0, 0, 0], [0.004]*3], rays=1000).F
assert F.shape == (9, 9) and abs(F[0].sum() - 1) < 1e-9
assert scipy.sparse.load_npz(\"bed.npz\").shape == (4, 4)
print(granrad.__name__, len(case.frames()), \"frames\")"
  sed -n "/^\`\`\`python/,/^\`\`\`/{/^\`\`\`/d;p}" /usr/share/doc/granrad/docs/tutorial_python.md >tutorial.py
  python3 tutorial.py >/dev/null'

say "links of the documents, manual pages, completion"
inside 'cd /usr/share/doc/granrad && for page in *.md docs/*.md; do
    for link in $(grep -oE "\]\([^)#: ]+" "$page" | cut -c3-); do
      test -e "$(dirname "$page")/$link" || { echo "$page: no $link"; exit 1; }
    done
  done'
add man-db bash-completion
inside 'man granrun 2>/dev/null | grep "run a scene" >/dev/null; man vfgen 2>/dev/null | grep "Correlation table" >/dev/null
  bash -c "source /usr/share/bash-completion/bash_completion; _completion_loader granrun; COMP_WORDS=(granrun re); COMP_CWORD=1; _granrad
    test \"\${COMPREPLY[*]}\" = \"report render\""'

say "find_package and pkg-config"
add g++ cmake make pkg-config
inside 'cp -r /usr/share/doc/granrad/example example; cd example
  cmake -S . -B build >/dev/null; cmake --build build >/dev/null; ./build/two_spheres
  g++ two_spheres.cpp -o by_pkg_config $(pkg-config --cflags --libs granrad); ./by_pkg_config'

hash='python3 -c "
import h5py, sys, hashlib
f = h5py.File(sys.argv[1]); print(hashlib.sha256(f[\"VTKHDF/PointData/temperature\"][:].tobytes()).hexdigest()[:16])"'
if ls "$folder"/granrad-mpi_*.deb >/dev/null 2>&1; then
  say "several processes"
  short='--set scene.end_time_s=0.01 --set radiation.rays=500 -q'
  ! inside "mpirun --version >/dev/null 2>&1"
  add "/tmp/granrad-mpi_*.deb" openssh-client
  inside "granrun run my.toml -o one $short
    OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n 2 granrun run my.toml -o two $short
    one=\$($hash \$(ls one/frames/*.hdf | tail -1)) two=\$($hash \$(ls two/frames/*.hdf | tail -1)); echo \"\$one \$two\"; test \"\$one\" = \"\$two\""
fi
if ls "$folder"/granrad-liggghts_*.deb >/dev/null 2>&1; then
  say "the engine on LIGGGHTS"
  ours="granrun run my.toml -o theirs --set dem.engine=liggghts --set scene.end_time_s=0.002 --set radiation.source=none -q"
  ! inside "$ours 2>refused"
  inside 'grep -q granrad-liggghts refused'
  before=$(inside 'ldd /usr/bin/granrun | wc -l')
  add "/tmp/granrad-liggghts_*.deb"
  inside "$ours; test -s theirs/history.csv; test \$(ldd /usr/bin/granrun | wc -l) = $before"
  echo "granrun loads $before libraries"
fi
say "all as promised"
