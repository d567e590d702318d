# Completion of hoodoo for fish. Verbs, options and keys come from the program itself.
complete -c hoodoo -n __fish_use_subcommand -f -a "(hoodoo --help 2>/dev/null | string match -r '^  [a-z]{3,} ' | string trim)"
complete -c hoodoo -n 'not __fish_use_subcommand' -a "(hoodoo (commandline -opc)[2] --help 2>/dev/null | string match -r '^  --[a-z-]+' | string trim)"
complete -c hoodoo -n 'test (commandline -opc)[-1] = --set' -f -a "(hoodoo keys --list 2>/dev/null | string replace -r '\$' '=')"
complete -c hoodoo -n '__fish_seen_subcommand_from keys' -f -a "(hoodoo keys --list 2>/dev/null)"
