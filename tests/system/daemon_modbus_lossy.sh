#!/bin/bash
# What a Modbus TCP server loses, damages or lets stand while a machine digs, one dig each: nothing wrong is
# published as good, every loss is counted, the next dig identifies the gravel.
. tests/system/daemon_lib.bash

make_digs
speed=4
series 6
config tcp "$modbus" "time_scale: $speed"
daemon_begins tcp
serve_series tcp --modbus-tcp "127.0.0.1:$port" --start-delay 2 --fault "$(fault drop=0.1 1)" --fault "$(fault drop=0.5 2)" \
    --fault "$(fault corrupt=0.1 3)" --fault "$(fault frozen 4)" --fault "$(fault stuck-pressures 5)"
daemon_ends tcp
judge tcp
digs_told=$(last health "$f" $h_digs)
check "the dig after them identifies the gravel" [ "$(judged dig 6 "$digs_told")" = 1 ]
check "a dig with damaged answers does so, too" [ "$(judged dig 6 3)" = 1 ]
# A request whose answer is lost is one that timed out; one at the very end may wait for it still.
check "requests without an answer are counted" within "$(last health "$f" $h_timeouts)" \
    $(($(rig modbus_unanswered) - 1)) "$(rig modbus_unanswered)"
check "damaged answers are counted" eval '[ "$(rig modbus_damaged)" -gt 20 ] && within "$(last health "$f" $h_malformed)" \
    "$(rig modbus_damaged)" "$(rig modbus_damaged)"'
check "frozen registers are counted" within "$(last health "$f" $h_frozen)" 100 1e6
check "nothing was lost on the way" [ "$(last health "$f" $h_lost)" = 0 ]
finish
