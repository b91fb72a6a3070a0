#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Every dependency, on every system and of tests as well, has a licence that deny.toml allows. Of alternatives (OR) one
# must be allowed, of parts (AND) all. Done here and not by cargo-deny, which takes longer to build than all the rest.
set -euo pipefail
cd "$(dirname "$0")/.."

# refused: of lines `NAME VERSION: LICENCE`, those that are not allowed.
refused() {
    awk '
    NR == FNR { if (match($0, /^ +"[^"]+"/)) { split($0, part, "\""); allowed[part[2]] = 1 }; next }
    {
        licence = $0
        sub(/^[^:]*: */, "", licence)
        gsub(/[()]/, "", licence)
        gsub(/\//, " OR ", licence)
        parts = split(licence, all, / AND /)
        good = parts > 0
        for (p = 1; p <= parts; p++) {
            any = 0
            choices = split(all[p], one, / OR /)
            for (c = 1; c <= choices; c++) if (one[c] in allowed) any = 1
            good = good && any
        }
        if (!good) print
    }' deny.toml -
}

# The control: what must not pass, and what must.
wrong=$'a 1: GPL-3.0\nb 1: MIT AND GPL-2.0\nc 1: (MIT OR Apache-2.0) AND MPL-2.0\nd 1: '
right=$'e 1: GPL-2.0 OR MIT\nf 1: MIT/Apache-2.0\ng 1: (MIT OR GPL-2.0) AND Zlib'
[ "$(printf '%s\n%s\n' "$wrong" "$right" | refused)" = "$wrong" ] || {
    echo "the check of licences does not work" >&2
    exit 1
}

# Lines such as `name v1.0.0 (proc-macro): MIT OR Apache-2.0 (*)`.
all=$(cargo tree --workspace --all-features --target all --edges normal,build,dev --prefix none --format '{p}: {l}' |
    sed 's/ (\*)$//; s/ ([^)]*): /: /; s/ ([^)]*): /: /' | sort -u)
[ "$(wc -l <<<"$all")" -gt 50 ] || {
    echo "cargo tree named too few packages" >&2
    exit 1
}
bad=$(refused <<<"$all")
if [ -n "$bad" ]; then
    printf 'licences that deny.toml does not allow:\n%s\n' "$bad" >&2
    exit 1
fi
