#!/usr/bin/env bash
# Says which C++ files are not laid out as .clang-format has it. Versions of clang-format differ in details, so only
# version 14 (Debian 12's) is asked; where it is not installed the check is skipped, and says so.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

formatter=
for candidate in clang-format-14 clang-format; do
  if "$candidate" --version 2>/dev/null | grep -q 'version 14\.'; then
    formatter=$candidate
    break
  fi
done
if [[ -z $formatter ]]; then
  echo "format: skipped, clang-format 14 is not installed"
  exit 0
fi

mapfile -t files < <(
  if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    git ls-files '*.cpp' '*.h'
  else
    find renderer images scene_io editing materials integrators apps tests -name '*.cpp' -o -name '*.h'
  fi
)
failed=0
for file in "${files[@]}"; do
  "$formatter" "$file" | cmp --silent - "$file" && continue
  echo "$file: is not formatted; run $formatter -i on it"
  failed=1
done
((failed)) || echo "format: ${#files[@]} files are in order"
exit "$failed"
