# Shared by the scripts in this folder, which source it from the checkout's top folder.

me=$(basename "$0")

# The comment at a script's head is its help.
print_usage() {
  sed -n '2,/^[^#]/s/^# \{0,1\}//p' "tools/$me"
}

# usage_error TEXT: prints one line and exits.
usage_error() {
  echo "$me: $1; see tools/$me --help" >&2
  exit 2
}

# find_apart [NAMESPACE...]: sets `apart` to a command prefix that starts a command in a new network namespace and the
# given further namespaces; empty, with status 1, if that is not permitted (most containers).
find_apart() {
  local root
  for root in '' '--user --map-root-user'; do
    # shellcheck disable=SC2206  # words, or none
    apart=(unshare $root --net "$@" sh -c
      'ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo && exec "$@"' sh)
    if "${apart[@]}" true 2>/dev/null; then return 0; fi
  done
  apart=()
  return 1
}

# Replaces this process by the same command in new namespaces. Their processes and network end with their first process,
# which ends with its parent. Returns in the new command, or if namespaces are not permitted.
become_apart() {
  if [ -n "${TREAD_APART:-}" ]; then return 0; fi
  if ! find_apart --pid --fork --kill-child --mount-proc && ! find_apart; then
    echo "$me: network namespaces are not permitted here; driving in the host's network"
    return 0
  fi
  TREAD_APART=yes exec setpriv --pdeathsig KILL "${apart[@]}" "tools/$me" "$@"
}

# choose_lcm_url [PORT]: sets `lcm_url`, the bus of a simulated drive: multicast, or TCP through tread-launch without a
# multicast route.
choose_lcm_url() {
  lcm_port=${1:-7668}
  lcm_url="udpm://239.255.76.67:$lcm_port?ttl=0&recv_buf_size=2097152"
  if ! ip route get 239.255.76.67 >/dev/null 2>&1; then
    lcm_url=tcpq://127.0.0.1:$lcm_port
    echo "$me: no multicast route, so messages go over $lcm_url"
  fi
}

# start_launch FILE ARGUMENT...: starts tread-launch in the background; it ends with this script. Its pid is in `launch`.
start_launch() {
  setpriv --pdeathsig TERM "$bin/tread-launch" "$@" --lcm-url "$lcm_url" &
  launch=$!
  # Clients that connect before the bus server listens are refused.
  while [[ $lcm_url == tcpq* ]] && kill -0 $launch 2>/dev/null && ! true 2>/dev/null >"/dev/tcp/127.0.0.1/$lcm_port"; do
    sleep 0.1
  done
}

# lock_folder FOLDER: creates and locks it; exits if another script uses it.
lock_folder() {
  mkdir -p "$1"
  exec 9>"$1/lock"
  if ! flock --nonblock 9; then
    echo "$me: another $me is running in this checkout" >&2
    exit 1
  fi
}

# remove_old PATH...: removes files of an earlier run, or exits.
remove_old() {
  if ! rm -rf "$@" 2>/dev/null; then
    echo "$me: $* cannot be removed; it may belong to another user" >&2
    exit 1
  fi
}

# build_programs LOG TARGET...: builds only these targets, or exits.
build_programs() {
  local log=$1
  shift
  echo "$me: building; the first time takes minutes ($log)"
  if ! tools/build release "$@" >"$log" 2>&1; then
    tail -30 "$log" >&2
    echo "$me: the build failed ($log)" >&2
    exit 1
  fi
  echo "$me: built"
}

# The programs of a simulated drive (config/launch/simulated*.yaml) and of its operator.
robot_programs=(tread-launch tread-logger tread-simulator tread-ins-driver tread-lidar-driver tread-mapping tread-learner
  tread-planner tread-motor-bridge tread-arm tread-goal tread-stop)
