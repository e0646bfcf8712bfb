# Bash completion of Digsight's programs. Commands, options and the words an option takes are those that the
# program's --help lists at that moment, so this file knows none of them. A word of the line is looked up only where it is
# spelt as a command or an option is: sed and compgen would run others.

_digsight()
{
    local cur prev words cword
    _init_completion || return
    local program=${words[0]/#\~/$HOME} command="" value="" table names

    [[ $cword -gt 1 && ${words[1]} =~ ^[a-z]+$ ]] && command=${words[1]}
    local help
    help=$("$program" $command --help 2>/dev/null) || return
    if [[ $prev =~ ^--?[a-z][a-z-]*$ ]]; then
        value=$(sed -n "s/^ .*$prev\(, --[a-z]*\)\{0,1\} \([^ ]\{1,\}\).*/\2/p" <<<"$help" | head -n 1)
    fi

    case $value in
    *'|'*) COMPREPLY=($(compgen -W "${value//|/ }" -- "$cur")) ;;
    FILE | DIR | RECORDING) _filedir ;;
    *.*) _filedir "${value##*.}" ;;
    NAME)
        for table in "${words[@]}"; do
            [[ $table == *.sqlite ]] || continue
            names=$(digtable list "$table" --json 2>/dev/null | sed -n 's/^ "trajectories": \[\(.*\)\],$/\1/p')
            COMPREPLY=($(compgen -W "${names//[^A-Za-z0-9_.-]/ }" -- "$cur"))
        done
        ;;
    ?*) ;;
    "")
        if [[ $cur == -* ]]; then
            COMPREPLY=($(compgen -W "$(sed -n 's/^  \(-., \|    \)\(--[a-z-]*\).*/\2/p' <<<"$help")" -- "$cur"))
        elif [[ $cword == 1 && $help == *$'\nCommands:\n'* ]]; then
            COMPREPLY=($(compgen -W "$(sed -n '/^Commands:$/,/^$/s/^  \([a-z]\{1,\}\)  .*/\1/p' <<<"$help")" -- "$cur"))
        else
            _filedir
        fi
        ;;
    esac
} &&
    complete -F _digsight digtable digloop digreport digrig digsightd digwatch
