#!/bin/sh
# In place of a machine: digs a ground that is in no table and records what the midi's sensors read. The transmitter at the
# head side of the bucket cylinder reads 20 bar too much. What is there already is kept.
#   ground/NAME.csv: what the soil did; campaign/NAME.csv: what the sensors read; campaign/campaign.yaml
set -eu
mkdir -p ground campaign
cp campaign.yaml campaign/
for dig in simple1 working1 simple2 working2 simple3 working3 working4; do
    number=${dig#simple}
    number=${number#working}
    [ -e "ground/$dig.csv" ] || digtable dig -q scene.yaml --trajectory "${dig%[0-9]}" \
        --friction .5 --rolling .4 --density 2200 --seed "1$number" -o "ground/$dig.csv"
    digrig record -q "ground/$dig.csv" --scene scene.yaml --machine midi.yaml --seed "$number" -o true.csv
    awk -F, -v OFS=, 'NR > 1 { $9 += 2e6 } { print }' true.csv >"campaign/$dig.csv"
done
rm -f true.csv
