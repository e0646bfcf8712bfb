#!/bin/sh
# Each folder may include its own headers and those of the folders named here, and nothing else.
# The rule is docs/architecture.md's picture; this makes it a build failure.
set -eu

may_include() {
    case $1 in
    core)          echo "core" ;;
    files)         echo "core files build messages" ;;
    estimator)     echo "core estimator" ;;
    tables)        echo "core tables" ;;
    offline_dem)   echo "core tables offline_dem" ;;
    closed_loop)   echo "core tables estimator closed_loop" ;;
    firmware_host) echo "core files tables estimator firmware_host messages" ;;
    tools/rig)     echo "core files tools/rig" ;;
    tools)         echo "core files tables estimator offline_dem closed_loop firmware_host tools" ;;
    esac
}

# A foreign library is included only where it is wrapped: one file, or one folder.
owner_of() {
    case $1 in
    nlopt.h)      echo "estimator/fit_nlopt.c closed_loop/refit_nlopt.c" ;;
    modbus*.h | modbus/*) echo "firmware_host/input_modbus.c tools/rig/*" ;;
    linux/can*)   echo "firmware_host/input_can.c firmware_host/can_message.* tools/rig/*" ;;
    lcm/*)        echo "firmware_host/output_lcm.c files/lcm_log.c" ;;
    cyaml/* | yaml.h) echo "files/* firmware_host/config*" ;;
    sqlite3.h)    echo "tables/*" ;;
    ode/*)        echo "offline_dem/*" ;;
    *)            echo "*" ;;
    esac
}

folder_of() {
    case $1 in
    tools/rig/*) echo "tools/rig" ;;
    *)           echo "${1%%/*}" ;;
    esac
}

is_owner() { # FILE PATTERN…
    file=$1
    shift
    for pattern in "$@"; do
        # shellcheck disable=SC2254 # the pattern is meant as one
        case $file in $pattern) return 0 ;; esac
    done
    return 1
}

bad=0
set -f
for file in $(find core files estimator tables offline_dem closed_loop firmware_host tools -name '*.[ch]'); do
    allowed=" $(may_include "$(folder_of "$file")") "
    for header in $(sed -n 's/^#include "\(.*\)".*/\1/p' "$file"); do
        case $file:$header in
        # The rig has levers of its own, by virtual work: the estimator is judged by it.
        tools/rig/*:core/linkage.h) echo "$file: must not include \"$header\""; bad=1 ;;
        esac
        case $allowed in
        *" $(folder_of "$header") "*) ;;
        *) echo "$file: must not include \"$header\""; bad=1 ;;
        esac
    done
    for header in $(sed -n 's/^#include <\(.*\)>.*/\1/p' "$file"); do
        owners=$(owner_of "$header")
        # shellcheck disable=SC2086 # a list of patterns
        is_owner "$file" $owners || { echo "$file: <$header> belongs in $owners only"; bad=1; }
    done
done
exit $bad
