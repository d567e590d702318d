# Completion of hoodoo for bash. Verbs, options and keys come from the program itself.
_hoodoo() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb=${COMP_WORDS[1]}
    COMPREPLY=()
    if [ "$COMP_CWORD" = 1 ]; then
        mapfile -t COMPREPLY < <(compgen -W "$("$1" --help 2>/dev/null | sed -n 's/^  \([a-z]\{3,\}\) .*/\1/p')" -- "$word")
    elif [ "$before" = --set ] || [ "$verb" = keys ]; then
        compopt -o nospace 2>/dev/null
        local ending==
        [ "$verb" = keys ] && ending=
        mapfile -t COMPREPLY < <(compgen -W "$("$1" keys --list 2>/dev/null)" -S "$ending" -- "$word")
    elif [ "$before" = --like ]; then
        mapfile -t COMPREPLY < <(compgen -W "$("$1" new --list 2>/dev/null | grep -v '^ ')" -- "$word")
    elif [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$("$1" "$verb" --help 2>/dev/null | sed -n 's/^  \(--[a-z-]*\).*/\1/p') --help" -- "$word")
    else
        compopt -o default 2>/dev/null
    fi
}
complete -F _hoodoo hoodoo
