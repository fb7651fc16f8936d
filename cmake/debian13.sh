#!/bin/sh
# sh cmake/run debian13: the two commands of the README in a bare Debian 13, from the committed sources. As root, in a
# mount namespace of its own (unshare): all mounts end with this script, also when it is killed.
#   debian13.sh <root of the sources> <folder of the build> <further arguments for cmake>
set -eu
source=$1
build=$2
shift 2
system=$build/root
mirror=${PALPATE_DEBIAN_MIRROR:-http://deb.debian.org/debian}

say() { echo "palpate: $*"; }
run_in() { chroot "$system" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 CI=true $kept "$@"; }

# The proxy of apt or of the environment, and what shortens the compilation; none of them has spaces.
kept=
for name in http_proxy https_proxy no_proxy CMAKE_BUILD_PARALLEL_LEVEL CMAKE_CXX_COMPILER_LAUNCHER; do
  eval "value=\${$name:-}"
  if [ "$name" = http_proxy ] && [ -z "$value" ]; then
    value=$(apt-config shell proxy Acquire::http::Proxy 2>/dev/null | sed "s/^proxy='\(.*\)'\$/\1/") || value=
  fi
  [ -z "$value" ] || { kept="$kept $name=$value"; export "$name=$value"; }
done

rm -rf "$system"
mkdir -p "$build"
say "Debian 13 from $mirror, log: $build/debootstrap.log"
debootstrap --variant=minbase trixie "$system" "$mirror" > "$build/debootstrap.log" 2>&1 ||
  { tail -n 5 "$build/debootstrap.log"; say "debootstrap failed; PALPATE_DEBIAN_MIRROR names another mirror"; exit 1; }
mount -t proc proc "$system/proc"
mount --rbind /dev "$system/dev"

mkdir "$system/palpate"
git -C "$source" archive HEAD | tar -x -C "$system/palpate"
say "sources: $(git -C "$source" log -1 --format='%h %s')"
if [ "${CMAKE_CXX_COMPILER_LAUNCHER:-}" = ccache ]; then
  cache=${CCACHE_DIR:-$HOME/.cache/ccache}
  mkdir -p "$cache" "$system/ccache"
  mount --bind "$cache" "$system/ccache"
  kept="$kept CCACHE_DIR=/ccache CCACHE_BASEDIR=/palpate CCACHE_SLOPPINESS=pch_defines,time_macros"
  run_in sh -c 'apt-get update && apt-get install -y --no-install-recommends ccache' > "$build/ccache.log" 2>&1
fi

failed=0
for what in demo test; do
  say "sh cmake/run $what, log: $build/$what.log"
  status=0
  run_in sh /palpate/cmake/run "$what" -- "$@" > "$build/$what.log" 2>&1 || status=$?
  tr '\r' '\n' < "$build/$what.log" | tail -n 12
  say "sh cmake/run $what: exit code $status, $(grep -c 'warning:' "$build/$what.log" || true) warnings"
  [ $status -eq 0 ] || failed=1
done
exit $failed
