# Sourced by the scripts beside it: folders, and an environment in which ROS 1 works.

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
build=$repository/build
workspace=$build/.workspace  # hidden: roslaunch looks for files in every other folder of a package

# Another python3 (pyenv, conda) earlier in PATH has none of ROS's modules.
export PATH=/usr/bin:$PATH
unset PYTHONPATH PYTHONHOME
# A workspace that happens to be sourced must not supply an older donex.
unset CMAKE_PREFIX_PATH ROS_PACKAGE_PATH

if [ -f /opt/ros/noetic/setup.bash ]; then
  set +u
  source /opt/ros/noetic/setup.bash
  set -u
fi

# Real scans, where there are any: the workspace's links lead away from the folder beside the checkout.
if [ -d "$repository/../shared/data" ]; then
  export DONEX_SHARED_DATA=${DONEX_SHARED_DATA:-$repository/../shared/data}
fi

# Logs and caches stay in the build folder, too (unless you have a compiler cache of your own).
export XAUTHORITY=${XAUTHORITY:-${HOME:-}/.Xauthority}
export HOME=$build/home ROS_HOME=$build/ros_home
export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-$build/home/runtime}
# shellcheck disable=SC2174  # the folders above need no protection
mkdir -p -m 700 "$HOME" "$build/home/runtime"
[ -n "${CCACHE_DIR:-}" ] || export CCACHE_DIR=$build/ccache CCACHE_MAXSIZE=1G
export CCACHE_NOHASHDIR=1 CCACHE_BASEDIR=$repository
# A node's messages as they come, not when a buffer is full.
export ROSCONSOLE_STDOUT_LINE_BUFFERED=1 PYTHONUNBUFFERED=1

cmake_arguments=(
  -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
  -DPYTHON_EXECUTABLE=/usr/bin/python3
  -DPython3_EXECUTABLE=/usr/bin/python3)
# Debian 11's catkin asks cmake-extras for GMock when a workspace is configured first; when it is again, the targets are lost.
if grep -qs '^VERSION_ID="11"' /etc/os-release; then cmake_arguments+=(-DCMAKE_DISABLE_FIND_PACKAGE_GMock=ON); fi

say() { printf '\n== %s\n' "$*"; }

fail() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# A catkin workspace of its own, wherever the checkout lies. The package in it is made of links to everything but
# the build folder: a link to the checkout itself would be a loop, which roslaunch and rosrun walk through.
make_workspace() {
  local entry
  rm -rf "$workspace/src/donex"
  mkdir -p "$workspace/src/donex"
  for entry in "$repository"/*; do
    [ "$entry" = "$build" ] || ln -s "$entry" "$workspace/src/donex/"
  done
}

source_setup() {
  set +u
  source "$1"
  set -u
}

# Builds the package in the workspace (not its tests), and takes on the workspace's environment.
build_workspace() {
  make_workspace
  say "Building in $workspace"
  catkin_make -C "$workspace" -j"$(nproc)" --cmake-args "${cmake_arguments[@]}"
  source_setup "$workspace/devel/setup.bash"
}

# A roscore of our own: never somebody else's, and no name resolution that a container may lack.
use_own_master() {
  local port
  port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])')
  export ROS_MASTER_URI=http://localhost:$port ROS_HOSTNAME=localhost
  unset ROS_IP
}

master_port() { echo "${ROS_MASTER_URI##*:}"; }
