#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Every tracked source file names the licences in its first line (in the second, below a #! line).
set -euo pipefail
cd "$(dirname "$0")/.."

# with_header FILE: whether it does.
with_header() {
    local first second
    { IFS= read -r first || true; IFS= read -r second || true; } <"$1"
    case $first in '#!'*) first=$second ;; esac
    # A carriage return at the end would be a different line.
    case $1 in
    *.rs | *.cl | *.clh | *.h | *.c | *.java | *.kt | *.kts) [ "$first" = '// SPDX-License-Identifier: MIT OR Apache-2.0' ] ;;
    *) [ "$first" = '# SPDX-License-Identifier: MIT OR Apache-2.0' ] ;;
    esac
}

# The control: a file without one is found.
control=$(mktemp --suffix .rs)
trap 'rm -f "$control"' EXIT
echo '//! No licence.' >"$control"
! with_header "$control" || { echo "licence headers: the check finds nothing" >&2; exit 1; }

count=0 missing=0
while IFS= read -r -d '' file; do
    [ -f "$file" ] || continue # removed, not yet committed
    count=$((count + 1))
    with_header "$file" || { echo "$file: no licence header" >&2; missing=$((missing + 1)); }
done < <(git ls-files -z -- '*.rs' '*.cl' '*.clh' '*.h' '*.c' '*.java' '*.kt' '*.kts' '*.sh' '*.toml' .ci/run)
[ $count -gt 0 ] || { echo "licence headers: git lists no file" >&2; exit 1; }
[ $missing = 0 ] || { echo "licence headers: $missing of $count files lack one" >&2; exit 1; }
echo "licence headers: all $count files have one"
