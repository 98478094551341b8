# Sourced by the commands of deploy and tests: one line a step, its output in a log file.

# Objects in ccache serve every checkout of the project, wherever it lies.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1

fail() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# step LOG TEXT COMMAND...: runs the command with its output in LOG; says TEXT and the seconds taken.
# On failure the end of the log is shown and 1 returned.
step() {
  local log=$1 text=$2 start=$SECONDS code=0
  shift 2
  mkdir -p "$(dirname "$log")"
  printf '%s ... ' "$text"
  "$@" >"$log" 2>&1 </dev/null || code=$?
  if [ "$code" = 0 ]; then
    echo "$((SECONDS - start)) s"
    return 0
  fi
  echo "failed after $((SECONDS - start)) s"
  tail -n 40 "$log" >&2
  echo "$(basename "$0"): '$text' failed with exit code $code; the whole log is $log" >&2
  return 1
}
