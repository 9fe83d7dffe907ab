# shellcheck shell=bash
# ./dev run: a street scene, recorded once as detections, goes over real LCM into the daemon, and
# the daemon is asked about it.

readonly RUN_CONFIG=config/plaza.json
readonly RUN_LOG=data/plaza.lcm
readonly RUN_SPEED=${ANCHORD_SPEED:-4}  # times as fast as it happened

command_run() {
  local keep=no
  if [[ -t 1 ]]; then keep=yes; fi
  case "${1:-}" in
    --keep) keep=yes ;;
    --once) keep=no ;;
    '') ;;
    *) fail "run takes --keep or --once, not $1" 2 ;;
  esac
  need "${PACKAGES_BUILD[@]}" "${PACKAGES_RUN[@]}"
  build_viewer
  configure_and_build release build anchord anchorctl anchor-play

  local port=7780
  while port_is_used "$port"; do port=$((port + 1)); done
  # An LCM port of its own, so that nothing else on the machine hears or disturbs the replay.
  local url="udpm://239.255.76.67:$((port + 10000))?ttl=0" data="$CACHE/run-$port"
  require_multicast
  rm -rf "$data"
  mkdir -p "$data"
  trap stop_run EXIT
  trap 'exit 130' INT
  trap 'exit 143' TERM

  start_daemon "$port" "$url" "$data"
  play_log "$url"
  ask_questions
  if [[ $keep == no ]]; then
    say "done: the daemon ends now (./dev run --keep leaves it serving)"
    return
  fi
  say "the daemon goes on serving:"
  echo "    look:  http://127.0.0.1:$port/ in a browser"
  echo "    ask:   build/anchorctl --server 127.0.0.1:$port where --class person"
  echo "    feed:  LCM channel ANCHORD_DETECTIONS at $url"
  echo "    stop:  Ctrl-C"
  wait "$daemon"
}

daemon='' watcher=''

start_daemon() {
  local port=$1 url=$2 data=$3
  ctl=(build/anchorctl --server "127.0.0.1:$port")
  local command=(build/anchord --config "$RUN_CONFIG" --data "$data" --lcm "$url"
    --http "127.0.0.1:$port")
  say "starting the daemon: ${command[*]}"
  "${command[@]}" >"$data/anchord.log" 2>&1 &
  daemon=$!
  local tries
  for ((tries = 0; tries < 100; tries++)); do
    if "${ctl[@]}" status >/dev/null 2>&1; then return; fi
    kill -0 "$daemon" 2>/dev/null || break
    sleep 0.1
  done
  tail -n 20 "$data/anchord.log" >&2
  fail "the daemon did not come up; the lines above are the end of $data/anchord.log"
}

play_log() {
  local url=$1
  say "playing $RUN_LOG over LCM, $RUN_SPEED times as fast as it happened; believed meanwhile:"
  "${ctl[@]}" watch &
  watcher=$!
  build/anchor-play --lcm "$url" --speed "$RUN_SPEED" "$RUN_LOG" || fail "the log did not play"
  sleep 0.5  # lets the last frames arrive: LCM gives no acknowledgement
  kill "$watcher" 2>/dev/null || true
  wait "$watcher" 2>/dev/null || true
  watcher=''
}

ask_questions() {
  ask "How many people are on the lawn?" count --class person --place lawn
  ask "Where is the person in red?" where --class person --color red
  ask "Which explanations compete right now?" hypotheses
}

# ask QUESTION ARGUMENT...: the question, the command that asks it, its answer.
ask() {
  printf '\n%s\n$ %s' "$1" "${ctl[*]}"
  shift
  printf ' %s' "$@"
  printf '\n'
  "${ctl[@]}" "$@" || fail "no answer"
}

stop_run() {
  local process
  for process in $watcher $daemon; do
    kill "$process" 2>/dev/null || continue
    wait "$process" 2>/dev/null || true
  done
}

port_is_used() { (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }

# LCM speaks UDP multicast, and the kernel sends none without a route.
require_multicast() {
  if ip route get 239.255.76.67 >/dev/null 2>&1; then return; fi
  fail "this machine has no route for multicast, which LCM needs. Either add one, as root:
    ip link set lo up; ip link set lo multicast on; ip route add 224.0.0.0/4 dev lo
or run in a network of its own, which only this shell sees:
    unshare --map-root-user --net bash -c \\
      'ip link set lo up; ip link set lo multicast on; ip route add 224.0.0.0/4 dev lo; ./dev run'"
}
