# SPDX-License-Identifier: Apache-2.0
# bash completion of palpate's programs: the options and subcommands that --help lists, else file names.
_palpate() {
  local current=${COMP_WORDS[COMP_CWORD]} help subcommands word words
  help=$("$1" --help 2>/dev/null)
  subcommands=$(sed -n '/^Subcommands:/,/^$/ s/^  \([a-z][a-z-]*\) .*/\1/p' <<<"$help")
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ -n $word ]] && grep -qxF -e "$word" <<<"$subcommands"; then
      help=$("$1" "$word" --help 2>/dev/null)
      subcommands=
      break
    fi
  done
  words=$subcommands
  if [[ $current == -* ]]; then
    words=$(sed -n 's/^  \(-[^ ]*\).*/\1/p' <<<"$help" | grep -oE -e '-?-[a-z0-9-]+')
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}
complete -o default -F _palpate palpate-{certify,device,feel,fit,inspect,latency,list,organ,parameters,query,replay,reproduce,security,server,solve,tool,viewer,watch}
