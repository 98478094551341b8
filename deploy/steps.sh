# Sourced by the commands of deploy and tests: one line per step, its output in a log file.

# Checkouts of the project share objects in ccache, whatever their paths.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1

PROGRESS_LINE_S=60  # between two lines of progress, where standard output is not a terminal

fail() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# progress_in LOG: how far the step is that writes LOG, "120 of 215: "; nothing if the log does not tell.
progress_in() {
  local ninja total
  ninja=$(tail -c 20000 "$1" | grep -oE '^\[[0-9]+/[0-9]+\]' | tail -n 1 | tr -d '[]') || true
  if [ -n "$ninja" ]; then
    echo "${ninja%/*} of ${ninja#*/}, "
  elif total=$(grep -m 1 -oE '[0-9]+ newly installed' "$1"); then
    # Each package is unpacked, then set up.
    echo "$(($(grep -cE '^(Unpacking|Setting up) ' "$1") / 2)) of ${total%% *} packages, "
  fi
}

# show_progress LOG TEXT: until it is killed, or the script has ended.
show_progress() {
  local log=$1 text=$2 start=$SECONDS shown=$SECONDS
  while sleep 1 && kill -0 $$ 2>/dev/null; do
    if [ -t 1 ]; then
      printf '\r%s ... %s%d s\033[K' "$text" "$(progress_in "$log")" $((SECONDS - start))
    elif [ $((SECONDS - shown)) -ge "$PROGRESS_LINE_S" ]; then
      shown=$SECONDS
      printf '%s%d s ... ' "$(progress_in "$log")" $((SECONDS - start))
    fi
  done
}

# step LOG TEXT COMMAND...: runs the command with its output in LOG; prints TEXT, progress and the seconds
# taken. On failure prints the end of the log and returns 1.
step() {
  local log=$1 text=$2 start=$SECONDS code=0
  shift 2
  mkdir -p "$(dirname "$log")"
  : >"$log"
  printf '%s ... ' "$text"
  show_progress "$log" "$text" &
  local shower=$!
  "$@" >"$log" 2>&1 </dev/null || code=$?
  kill "$shower" 2>/dev/null || true
  wait "$shower" 2>/dev/null || true
  [ ! -t 1 ] || printf '\r\033[K%s ... ' "$text"
  if [ "$code" = 0 ]; then
    echo "$((SECONDS - start)) s"
    return 0
  fi
  echo "failed after $((SECONDS - start)) s"
  tail -n 40 "$log" >&2
  echo "$(basename "$0"): '$text' failed with exit code $code; the full log is $log" >&2
  return 1
}
