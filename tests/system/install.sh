#!/bin/bash
# make install under a folder: every program has a manual page for itself and each command, completion completes what
# --help lists, the configuration is loaded from where it was put; make uninstall takes all of it away again.
. tests/system/check.bash
command -v help2man >/dev/null || { echo "SKIP: no help2man here to make manual pages"; echo "0 passed, 0 failed, 1 skipped"; [ -z "${DIG_NO_SKIP-}" ]; exit; }
root=$work/root prefix=/opt/test
build=${BIN%/bin}
in_make() { make --no-print-directory BUILD="$build" DESTDIR="$root" PREFIX=$prefix "$@" >"$work/out" 2>"$work/err"; }
put=$root$prefix

check "make install does" in_make install
commands_of() { "$put/bin/$1" --help | sed -n '/^Commands:$/,/^$/s/^  \([a-z]\{1,\}\)  .*/\1/p'; }
without_page() { # programs and commands
    local program command
    for program in "$put"/bin/*; do
        program=${program##*/}
        for command in "" $(commands_of "$program"); do
            grep -q '^.SH EXAMPLES' "$put"/share/man/man[18]/"$program${command:+-$command}".[18] 2>/dev/null ||
                echo "$program $command"
        done
    done
}
check "every program and command has a manual page with examples" eval '[ -z "$(without_page | tee "$work/err")" ]'
without_option() { # options of `digtable dig` that its page lacks
    sed 's/\\-/-/g' "$put/share/man/man1/digtable-dig.1" >"$work/page"
    "$put/bin/digtable" dig --help | grep -oE '^ .{5}--[a-z-]+' | grep -oE -- '--.*' | while read -r option; do
        grep -qF -- "$option" "$work/page" || echo "$option"
    done
}
check "a page tells every option that --help does" eval '[ -z "$(without_option | tee "$work/err")" ] && grep -q save-bed "$work/page"'
if command -v man >/dev/null; then
    check "man has no word against any page" eval '[ -z "$(for p in "$put"/share/man/man?/*; do
        MANROFFSEQ= man --warnings -E UTF-8 -l "$p" 2>&1 >/dev/null; done | tee "$work/err")" ]'
fi

for config in "$put"/etc/digsight/digsightd.yaml "$put"/share/digsight/config/digsightd.yaml; do
    # Where it is going to be is not where it is.
    sed "s|: $prefix|: $put|g" "$config" >"$config.here"
    check "digsightd --check is content with ${config#"$put"}" \
        eval '"$put/bin/digsightd" -c "$config.here" --check >"$work/out" 2>"$work/err"'
    rm "$config.here"
done
check "so is a program that reads what it said" eval '"$put/bin/digsightd" -c config/digsightd.yaml --check --json |
    tee "$work/err" | tr -d "\n" | grep -qE "\"machine\": \{\"name\": \"zx200_trench\".*\"not_measured\": \[\]\}$"'
check "a table that was put there is shown" eval '"$put/bin/digtable" show "$put/share/digsight/tables/reference_rig.sqlite" 0 --json >"$work/out"'
if /usr/bin/python3 -c 'import pandas' 2>/dev/null; then
    check "Python reads it" eval 'PYTHONPATH=$put/share/digsight/python /usr/bin/python3 -B -c "import digsight, sys
print(digsight.open_table(sys.argv[1]))" "$put/share/digsight/tables/reference_rig.sqlite" >"$work/out" 2>"$work/err"'
fi
check "the unit starts the program and the configuration that were put there" \
    grep -qx "ExecStart=$prefix/bin/digsightd -c $prefix/etc/digsight/digsightd.yaml" "$put/lib/systemd/system/digsightd.service"

if [ -e /usr/share/bash-completion/bash_completion ]; then
    completes() { # LINE WORDS: what is proposed at the line's end holds all of them
        PATH="$put/bin:$PATH" bash -c '
            . /usr/share/bash-completion/bash_completion
            . "$0/share/bash-completion/completions/digtable"
            COMP_LINE=$1 COMP_POINT=${#1}
            read -ra COMP_WORDS <<<"$1"
            [[ $1 != *" " ]] || COMP_WORDS+=("")
            COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
            _digsight
            printf "%s\n" "${COMPREPLY[@]}"' "$put" "$1" >"$work/err" 2>&1
        local word
        for word in $2; do grep -qxF -- "$word" "$work/err" || return 1; done
    }
    check "commands are completed" completes "digtable s" "show submit status"
    check "so are a command's options" completes "digloop identify --m" "--machine --model --moment-alone"
    check "not those of another" eval '! completes "digtable list --" --seed'
    check "words that an option takes" completes "digtable dig --engine " "single kernel ode cuda"
    check "a table's trajectories" completes "digloop predict tables/reference_rig.sqlite --trajectory s" "simpleA simpleB"
    check "no word of the line runs" eval '! completes "digtable list -//;e>$work/OWNED;# " x && [ ! -e "$work/OWNED" ]'
    check "files of the right kind" completes "digsightd -c config/digsightd_" "config/digsightd_can.yaml config/digsightd_rtu.yaml"
else
    skip_check "what is completed" "no bash-completion here"
    check "... which is not asked to be there" [ -z "${DIG_NO_SKIP-}" ]
fi

echo "# mine" >>"$put/etc/digsight/digsightd.yaml"
check "a second install leaves a configuration that was changed" \
    eval 'in_make install && grep -q "# mine" "$put/etc/digsight/digsightd.yaml" && grep -q "was changed" "$work/err"'
check "so does uninstall, which leaves nothing else" \
    eval 'in_make uninstall && [ "$(find "$root" -type f)" = "$put/etc/digsight/digsightd.yaml" ]'
rm "$put/etc/digsight/digsightd.yaml"
check "without one nothing at all is left" \
    eval 'in_make install && in_make uninstall && [ -z "$(find "$root" -type f | tee "$work/err")$(find "$put" -type d -name "digsight*")" ]'
finish
