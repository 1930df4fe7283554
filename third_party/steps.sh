# SPDX-License-Identifier: BSD-3-Clause
# Sourced by demo, check and third_party/setup: named steps with progress, a log, and the tail of the log on failure.
# The caller sets `task` (its name) and `project` (the top of the tree).

log="$project/build/log/$task.log"
mkdir -p "$project/build/log"
: >"$log"
started=$SECONDS

# say LINE...: to the terminal and the log.
say() { printf '%s\n' "$@" | tee -a "$log"; }

fail() {
  say "$task: FAILED: $*"
  say "$task: the full log is $log"
  exit 1
}

# as_text SECONDS: "3 s" or "2 min 05 s".
as_text() {
  if [ "$1" -lt 60 ]; then printf '%d s' "$1"; else printf '%d min %02d s' $(($1 / 60)) $(($1 % 60)); fi
}

# step "what happens" COMMAND...: runs the command into the log, with a heartbeat: every second on a terminal, a line a
# minute elsewhere.
step() {
  local what=$1 begun=$SECONDS pid minutes=0
  shift
  printf '%s: %s ...\n' "$task" "$what" >>"$log"
  "$@" >>"$log" 2>&1 </dev/null &
  pid=$!
  while kill -0 "$pid" 2>/dev/null; do
    if [ -t 1 ]; then
      printf '\r%s: %s ... %s ' "$task" "$what" "$(as_text $((SECONDS - begun)))"
    elif [ $(((SECONDS - begun) / 60)) -gt "$minutes" ]; then
      minutes=$(((SECONDS - begun) / 60))
      printf '%s: %s ... %s\n' "$task" "$what" "$(as_text $((SECONDS - begun)))"
    fi
    sleep 1
  done
  if [ -t 1 ]; then printf '\r'; fi
  if wait "$pid"; then
    say "$task: $what: done in $(as_text $((SECONDS - begun)))"
  else
    tail -n 40 "$log" >&2
    fail "$what"
  fi
}

# preset NAME TARGET...: configures the preset and builds the targets.
build_preset() {
  local name=$1
  shift
  step "configure preset $name" cmake --preset "$name" ${cmake_options[@]+"${cmake_options[@]}"}
  step "build preset $name ($*)" cmake --build --preset "$name" --parallel "$(nproc)" --target "$@"
}

# python_with MODULE...: prints the first python3 that has the modules; the distribution's own may not be first in PATH.
python_with() {
  local candidate module
  for candidate in python3 /usr/bin/python3; do
    for module in "$@"; do "$candidate" -c "import $module" 2>/dev/null || continue 2; done
    printf '%s\n' "$candidate"
    return
  done
  return 1
}
