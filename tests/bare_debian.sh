#!/usr/bin/env bash
# Installs a Debian package of Cradle on a machine that has nothing, and does what a user would do first: runs and plots
# Fig. 2, from the shell and in Python, as a live simulation too. Needs root, debootstrap and a network; the package
# must be of that release.
#   tests/bare_debian.sh bookworm|trixie PACKAGE.deb [FOLDER]
set -euo pipefail
suite=$1 package=$(realpath "$2") root=${3:-$(mktemp -d)}
[[ -x $root/usr/bin/apt-get ]] || debootstrap --variant=minbase "$suite" "$root"
cp "$package" "$root/tmp/cradle.deb"
for folder in proc dev; do
  mountpoint -q "$root/$folder" && continue
  mount --rbind "/$folder" "$root/$folder"
  mount --make-rslave "$root/$folder"  # else unmounting it there unmounts it here
done
trap 'umount -Rl "$root/proc" "$root/dev"' EXIT
chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive HOME=/root bash -euxc '
  cd "$(mktemp -d)"
  apt-get -qq update
  apt-get -qq install -y /tmp/cradle.deb
  cradle run fig2 --quiet
  cradle plot fig2.h5
  python3 -c "import cradle; print(cradle.open(\"fig2.h5\"), cradle.check(\"fig2\").seconds)"
  python3 -c "import cradle; sim = cradle.Simulation(\"fig2\"); sim.advance(50); print(sim); assert sim.collisions > 0"
  apt-get -qq remove -y cradle
  test ! -e /usr/lib/python3/dist-packages/cradle'
echo "$suite: installed, run, plotted, imported, removed"
