#!/bin/bash
# scripts/mends.sh: takes out, one at a time, what keeps hostile input out, and runs the test that holds it: it must fail.
# A line each; exits 1 where a test passed all the same. In a copy of the sources and objects. `make mends`.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# NAME|FILE|what sed does to it|the test that must fail
mends='
markup in a page is escaped|closed_loop/report/html.c|s/case .<.:.*$//|firmware_host/test_hostile_texts
also what a format puts there|core/markup.c|s/markup->text(to, \(va_arg.*, const char \*)\));/(void)fputs(\1, to);/|closed_loop/test_trace_report
text of a picture is escaped, and no command|closed_loop/report/plot.c|s/^    dig_html_text(to, text);/    (void)fputs(text, to);/|closed_loop/test_plot
a start-up file of gnuplot is not run|closed_loop/report/plot.c|s/"-d"/"--"/|closed_loop/test_plot
a word of a shell line is quoted|core/shell.c|s/if (word.0. != .*$/if (true) {/|core/test_shell
a name has no blank and no sign|core/name.c|s/789_.-"/789_.- `$"/|core/test_name
an error is one line, whatever it quotes|core/error.c|s/(c = strpbrk(c, .*)) != NULL/c == NULL/|core/test_text
a link in a folder of jobs is not followed|tools/digtable/job_folder.c|s/: !S_ISREG(is.st_mode)/: false/|digtable/test_job_folder
a path stays in its folder|core/name.c|s/return !up;/return true;/|core/test_name
a recording of a campaign stays in its folder|files/campaign_yaml.c|s/dig_path_stays(name)/true/|files/test_campaign_yaml
no escape sequence reaches a terminal or a page|core/text.c|s/c.0. < 0x20/c[0] < 0x02/|core/test_text
nor by the name of a file|core/text.c|s/^    dig_text_clean(text);/    (void)text;/|core/test_text
no table but our own, no trigger, no view|tables/schema/guard.c|s/^    compare(found.*;//|tables/test_hostile
a schema is ours word for word|tables/schema/guard.c|s/strcmp(text_at(found, 3), text_at(expected, 3)) != 0/false/|tables/test_hostile
a journal of several tables deletes nothing|tables/open.c|s/(flags & SQLITE_OPEN_SUPER_JOURNAL) != 0/false/|tables/test_hostile
a pipe or a link beside a table is not opened|tables/open.c|s/!S_ISREG(found.st_mode)/false/|tables/test_hostile
a table is the file of its very name|tables/open.c|s,"" : "./","" : "",|tables/test_hostile
no table is made through a link|tables/store.c|s/O_CREAT . O_EXCL/O_CREAT/|tables/test_hostile
a flipped bit is found at opening|tables/schema/head.c|s/dig_seal_check(db);//|tables/test_seal
a text of megabytes is no configuration|files/yaml/yaml_tree.c|s/(2 << 20)/(200 << 20)/|files/test_yaml_tree
anchors without number are refused|files/yaml/yaml_tree.c|s/anchors > SIGNS_MOST/anchors > 1000 * SIGNS_MOST/|files/test_yaml_tree
directives without number are refused|files/yaml/yaml_tree.c|s/directives > SIGNS_MOST/directives > 1000 * SIGNS_MOST/|files/test_yaml_tree
what nests without end is refused|files/yaml/yaml_tree.c|s/depth > DEPTH_MOST)/depth > 10000 * DEPTH_MOST)/|files/test_yaml_tree
a pipe or device is refused at once|core/regular.c|s/!S_ISREG(found.st_mode)/0/|core/test_regular
a link where a part should go is not followed|core/part.c|s/if (unlink(path) != 0/if (path == NULL/;s/O_EXCL . O_NOFOLLOW/O_TRUNC/|core/test_part
a link where an output should go is replaced|files/text/whole.c|s/S_ISLNK(named.st_mode)/false/|files/test_whole
a Modbus answer to another request is none|firmware_host/bus/modbus_tcp.c|s/memcmp(answer, request, LENGTH) == 0/true/|firmware_host/test_modbus_tcp
a Modbus answer that lies of its length is none|firmware_host/bus/modbus_tcp.c|s/number_at(answer, LENGTH) == (unsigned)size - UNIT/true/|firmware_host/test_modbus_tcp
an LCM channel ends within its datagram|files/lcm/lcm_datagram.c|s/memchr(channel, .*/memchr(channel, 0, 65000);/|files/test_lcm_datagram
a part of an LCM message is none|files/lcm/lcm_datagram.c|s/memcmp(bytes, short_message, sizeof short_message)/memcmp(bytes, short_message, 3)/|files/test_lcm_datagram
an LCM message longer than it says is none|files/lcm/lcm_layout.c|s/return at == size;/return true;/|files/test_lcm_layout
a recording beyond all numbers is refused|files/recording_csv.c|s/!(fabs(row\[k\]) > VALUE_MAX)/true/|files/test_recording_csv
digs beyond all numbers end a fit|closed_loop/fit/posterior.c|s/!isfinite(weigh(c, power, weight))/weigh(c, power, weight) < 0.0/|closed_loop/test_posterior
no table stands in the place of a closed stream|core/streams.c|s/fcntl(fd, F_GETFD) < 0/0/|core/test_streams
a box of more grains than memory holds is refused|offline_dem/dig/packing.c|s/!(total <= MOST) .. (double)n > MOST/false/|offline_dem/test_packing
a number of an LCM message is within it|files/lcm/lcm_layout.c|s/number >= 0 \&\& (size_t)number <= INT32_MAX . 8/true/|files/test_lcm_layout
'

cp -a Makefile core files messages tables estimator firmware_host offline_dem closed_loop tools scripts config "$work/"
mkdir "$work/tests" "$work/build"
cp -a tests/*.[ch] "$work/tests/"
for folder in core files tables firmware_host offline_dem closed_loop digtable; do cp -a "tests/$folder" "$work/tests/"; done
ln -s "$PWD/tests/data" "$work/tests/data"
cp -a build/*.a build/messages build/core build/files build/tables build/estimator build/firmware_host build/offline_dem \
    build/closed_loop "$work/build/"

passed=0 failed=0
while IFS='|' read -r name file change test; do
    [ "$name" ] || continue
    cp -p "$work/$file" "$work/kept"
    sed -i "$change" "$work/$file"
    if cmp -s "$work/$file" "$work/kept"; then
        echo "mends: $file no longer holds what to take out for: $name" >&2
        failed=$((failed + 1))
    elif ! make -s -C "$work" "build/tests/$test" CFLAGS="-O1 -w" >"$work/log" 2>&1; then
        cat "$work/log" >&2
        failed=$((failed + 1))
    elif (cd "$work" && timeout 60 "build/tests/$test") >"$work/log" 2>&1; then
        echo "FAIL  without it tests/$test.c passes: $name"
        failed=$((failed + 1))
    else
        echo "ok    $name: tests/$test.c fails without it"
        passed=$((passed + 1))
    fi
    mv "$work/kept" "$work/$file"
    touch "$work/$file"
done <<<"$mends"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
