# shellcheck shell=bash
# Sourced by the other scripts. Gives them a clean environment, the repository's folders (DESERT_ROOT, BUILD),
# and the steps desert_install, desert_configure, desert_build and desert_ros_environment.

DESERT_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
BUILD=${DESERT_BUILD_DIR:-$DESERT_ROOT/build}
[[ $BUILD == /* ]] || BUILD=$PWD/$BUILD
ROS_SETUP=/opt/ros/noetic/setup.bash

say() { printf '== %s\n' "$*"; }
fail() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

# The system's python3 and tools come first (pyenv and conda hide them), nvcc is found where it usually lives.
PATH=/usr/sbin:/usr/bin:/sbin:/bin:$PATH
[[ -x /usr/local/cuda/bin/nvcc ]] && PATH=/usr/local/cuda/bin:$PATH
unset PYTHONHOME PYTHONPATH
export PATH ROS_VERSION=1 ROS_PYTHON_VERSION=3
# Messages are generated for C++ and Python; nothing here needs those of the other languages.
export ROS_LANG_DISABLE=${ROS_LANG_DISABLE-geneus:genlisp:gennodejs}

# The system, such as "debian 12".
system_release() {
  # shellcheck disable=SC1091
  (. /etc/os-release 2>/dev/null && echo "${ID:-} ${VERSION_ID:-}")
}
# 1: Debian's column of dependencies.txt, 2: that of Ubuntu 20.04, 0: a system we have no names for.
system_column() {
  case $(system_release) in
    "debian 11" | "debian 12" | "debian 13") echo 1 ;;
    "ubuntu 20.04") echo 2 ;;
    *) echo 0 ;;
  esac
}
DESERT_SYSTEM=$(system_column)
# Whose packages are named: where nothing is installed, those of Debian 12.
DESERT_RELEASE=$(system_release)
[[ $DESERT_SYSTEM != 0 ]] || DESERT_RELEASE='debian 12'

source_noetic() {
  [[ -r $ROS_SETUP ]] || return 1
  set +u # ROS's setup files read unset variables
  # shellcheck disable=SC1090
  . "$ROS_SETUP"
  set -u
}
# Debian's ROS lives under /usr and takes no distribution name.
source_noetic || unset ROS_DISTRO

# The names in one column of dependencies.txt, of the parts that somebody needs:
#   nothing said: all that builds, runs and is tested    window: scripts/demo    film: scripts/demo --headless
#   client: DESERT_PARTS=client    core: a build without ROS    sanitizers: all, and the part `Sanitizers`
#   checks, flakes: the part `Checks` or `Flakes` alone
packages() { # column [window | film | client | core | sanitizers | checks | flakes]
  local nodes='tools|client|simulation|nodes' parts
  local all="$nodes|kit|window|film|more|more of ROS"
  case ${2:-} in
    window | film) parts="$nodes|$2" ;;
    client) parts='tools|client|kit' ;;
    core) parts='tools|simulation|more' ;;
    sanitizers) parts="$all|Sanitizers" ;;
    checks) parts='Checks' ;;
    flakes) parts='Flakes' ;;
    '') parts=$all ;;
    *) fail "there is no list of packages '$2'" ;;
  esac
  awk -F'|' -v column="$1" -v parts="^# ($parts):" -v release="${DESERT_RELEASE##* }" '
    /^#/ { wanted = $0 ~ parts }
    !wanted { next }
    { sub(/#.*/, ""); name = $column; gsub(/^[ \t]+|[ \t]+$/, "", name) }
    match(name, / \[.*\]$/) { # the releases that have it
      if (index(" " substr(name, RSTART + 2, RLENGTH - 3) " ", " " release " ") == 0) next
      name = substr(name, 1, RSTART - 1)
    }
    name != "" && name != "-" { print name }
  ' "$DESERT_ROOT/scripts/dependencies.txt"
}

missing_packages() { # column [list, as of packages()]
  local package
  for package in $(packages "$@"); do
    dpkg-query -W -f '${Status}\n' "$package" 2>/dev/null | grep -q 'ok installed' || echo "$package"
  done
}

# Installs what is missing from dependencies.txt; with nothing missing it calls nothing.
# shellcheck disable=SC2120 # arguments are optional
desert_install() { # [list, as of packages()]
  local missing as_root=()
  if [[ $DESERT_SYSTEM == 0 ]]; then
    say "this is neither Debian 11, 12 or 13 nor Ubuntu 20.04: nothing is installed. Needed, by their Debian names:"
    packages 1 "$@" | paste -sd' '
    return
  fi
  mapfile -t missing < <(missing_packages "$DESERT_SYSTEM" "$@")
  ((${#missing[@]})) || return 0
  if ((EUID != 0)); then
    command -v sudo >/dev/null || fail "missing packages, and no sudo to install them. As root: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  as_root+=(env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get -q -o Acquire::Retries=3)
  "${as_root[@]}" update || say "apt-get update failed; trying with the package lists at hand"
  say "installing ${missing[*]}"
  # What comes with them: "0 upgraded, 674 newly installed, ...", "Need to get 343 MB ...", "After this operation, ...".
  { "${as_root[@]}" install --assume-no --no-install-recommends "${missing[@]}" || true; } 2>/dev/null |
    sed -nE '/newly installed|^Need to get|^After this/s/^/== /p'
  if ! "${as_root[@]}" install -y --no-install-recommends "${missing[@]}"; then
    [[ $DESERT_SYSTEM == 2 && ! -r $ROS_SETUP ]] &&
      say "ROS Noetic's packages need its apt source: see http://wiki.ros.org/noetic/Installation/Ubuntu"
    fail "could not install: ${missing[*]}"
  fi
  source_noetic || true
}

# A new build is one of Ninja, which keeps all processors busy to the end; one that exists stays what it is.
# shellcheck disable=SC2120 # arguments are optional
desert_configure() { # [-DNAME=VALUE]...
  if command -v ninja >/dev/null; then export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}; fi
  say "configuring $BUILD"
  cmake -S "$DESERT_ROOT" -B "$BUILD" "$@"
}

# shellcheck disable=SC2120 # arguments are optional
desert_build() { # [--target NAME]...
  say "building ${*:-all}"
  cmake --build "$BUILD" -j "${DESERT_JOBS:-$(nproc)}" "$@"
}

desert_has_target() { # name
  cmake --build "$BUILD" --target help | grep -E "(^|[ .])$1(:|\$)" >/dev/null
}

free_port() {
  python3 -c 'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])'
}

# A ROS master of our own, on this machine only.
desert_own_master() {
  ROS_MASTER_URI=http://localhost:$(free_port)
  export ROS_MASTER_URI ROS_HOSTNAME=localhost
  unset ROS_IP
}

# rosrun and roslaunch know desert_sim from here on.
desert_ros_environment() {
  [[ -r $BUILD/devel/setup.bash ]] || fail "built without ROS (see the line 'desert_sim ...' of the configuration above)"
  set +u
  # shellcheck disable=SC1091
  . "$BUILD/devel/setup.bash"
  set -u
}
