#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# How scripts/khronos-contact-sheet counts models that open, that are refused by name, and that fail, with a program
# that stands for nearlight. 77 says that oiiotool is missing.
set -euo pipefail
command -v oiiotool > /dev/null || exit 77
sheet=$1/scripts/khronos-contact-sheet
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p models/good/glTF
touch models/good/glTF/good.gltf models/refused.glb models/broken.glb

cat > nearlight <<'END'
#!/bin/bash
case $2 in
    */good.gltf) oiiotool --create 16x12 3 --addc 0.4 -d uint8 -o "$4" ;;
    */refused.glb) echo "nearlight: error: $2: needs the extension KHR_x, which is not supported" >&2; exit 3 ;;
    *) echo "nearlight: error: $2: not a valid glTF file" >&2; exit 3 ;;
esac
END
chmod +x nearlight

expect() {  # TEXT STATUS: the script's last line and exit status
    local status=0
    text=$("$sheet" models --nearlight ./nearlight --size 16x12 -o sheet.html | tail -1) || status=$?
    [ "$text" = "$1" ] && [ "$status" = "$2" ] && return
    echo "'$text' and the status $status instead of '$1' and $2"
    exit 1
}
expect "3 models: 1 rendered, 1 refused by name, 1 bad" 1
[ -s sheet.html ] && [ -s sheet-1.png ]  # although the good one has no screenshot
rm models/broken.glb
expect "2 models: 1 rendered, 1 refused by name, 0 bad" 0
