#!/bin/bash
# python/digsight reads what digtable and digloop write, on Debian's own Python; every recipe of docs/python.md runs.
python=/usr/bin/python3
if ! "$python" -c 'import pandas, xarray' 2>/dev/null; then
    echo "SKIP  tables and traces in Python: $python has no pandas or xarray (python3-pandas, python3-xarray)"
    echo "0 passed, 0 failed, 1 skipped"
    [ -z "${DIG_NO_SKIP-}" ]
    exit
fi
PYTHONPATH=python PYTHONDONTWRITEBYTECODE=1 exec "$python" -W error tests/python/test_digsight.py
