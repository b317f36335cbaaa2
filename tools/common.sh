# SPDX-License-Identifier: Apache-2.0
# What the shell commands in this folder share. Sourced, never run.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '\n== %s\n' "$*"; }

fail() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# run_logged LOG COMMAND...: keeps the output in LOG; shows its end when the command fails, and returns its code.
run_logged() {
  local log=$1 code=0
  shift
  mkdir -p "$(dirname "$log")"
  "$@" >"$log" 2>&1 || code=$?
  if ((code != 0)); then
    tail -n 30 "$log" >&2
    printf '%s: "%s" ended with code %d; all of it is in %s\n' "$(basename "$0")" "$*" "$code" "$log" >&2
  fi
  return "$code"
}

# What this machine has compiled before, in whatever folder, where it has ccache.
if command -v ccache >/dev/null; then
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
  export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=true CCACHE_SLOPPINESS=pch_defines,time_macros
fi

# build PRESET [TARGET...]: configures and builds on all cores; everything when no target is named.
build() {
  local preset=$1
  shift
  local log=$root/build/$preset.log
  cd "$root"
  run_logged "$log" cmake --preset "$preset" || return
  run_logged "$log" cmake --build --preset "$preset" --parallel "$(nproc)" ${1:+--target "$@"}
}

# Keeps DDS on this machine unless the caller has a configuration: works without a network and in containers whose
# loopback has no multicast, and nobody else's programs are heard.
use_loopback() {
  export CYCLONEDDS_URI=${CYCLONEDDS_URI:-"<CycloneDDS><Domain><General><Interfaces>\
<NetworkInterface name=\"lo\" multicast=\"false\"/></Interfaces><AllowMulticast>false</AllowMulticast></General>\
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>30</MaxAutoParticipantIndex>\
<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>"}
}

# A DDS domain from 1 to 100 none of whose UDP ports (7400 + 250 per domain) is taken. Above 100 they meet the
# ports that Linux gives out by itself.
free_domain() {
  local taken domain attempt
  taken=$(awk 'FNR > 1 { split($2, a, ":"); print a[2] }' /proc/net/udp /proc/net/udp6 2>/dev/null |
    while read -r port; do echo $(((16#$port - 7400) / 250)); done)
  for ((attempt = 0; attempt < 200; ++attempt)); do
    domain=$((RANDOM % 100 + 1))
    grep -qx "$domain" <<<"$taken" || { echo "$domain"; return; }
  done
  fail "no free DDS domain among 1 to 100"
}

# The sample command lines of a README: the sh block after the line "<!-- samples: tools/check runs them -->".
samples_of() {
  awk '/^<!-- samples: tools\/check runs them -->/ { armed = 1 } armed && /^```sh/ { inside = 1; next }
       /^```/ { if (inside) armed = 0; inside = 0 } inside' "$1"
}
