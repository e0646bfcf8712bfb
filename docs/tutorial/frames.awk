# A machine recording (CSV) as the midi's CAN frames (midi.dbc), in candump's log format for canplayer:
#   awk -F, -f frames.awk campaign/simple1.csv >midi.log; canplayer -I midi.log vcan0=can0
function hex16(x,    n) { n = x < 0 ? int(x - 0.5) : int(x + 0.5); return sprintf("%04X", n < 0 ? n + 65536 : n) }
function degrees(rad,    h) { h = hex16(rad * 18000 / atan2(0, -1)); return substr(h, 3) substr(h, 1, 2) } # low byte first
function bars(Pa) { return hex16((Pa / 1e5 + 10) * 100) }
NR == 1 { next }
NR % 2 == 0 { # every 10 ms of 5 ms rows
    printf "(%.6f) can0 18FD1501#%s%s%s%02X00\n", $1, degrees(-$2), degrees(-$3), degrees($4), ++alive % 256
    printf "(%.6f) can0 321#%s%s%s%s\n", $1, bars($5), bars($6), bars($7), bars($8)
    printf "(%.6f) can0 322#%s%s\n", $1, bars($9), bars($10)
}
