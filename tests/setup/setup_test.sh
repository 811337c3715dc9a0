#!/usr/bin/env bash
# What the set-up promises: nothing missing means no apt and no root; something missing and no way to
# install it means one line to paste, exit 1, nothing written. Runs on a copy of the clone, as the user
# `nobody` where this is root, else as the current user. apt-get and sudo are stand-ins that record their
# calls, so the test never installs anything.
#   setup_test.sh SOURCE_FOLDER
set -eu

source=$1
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
chmod 755 "$work"
failures=0

fail() {
  echo "FAILED: $*"
  sed 's/^/  stdout: /' "$work/stdout"
  sed 's/^/  stderr: /' "$work/stderr"
  sed 's/^/  called: /' "$work/calls"
  failures=$((failures + 1))
}

# ---- a copy of the clone, stand-ins for apt-get and sudo, a list with a package that cannot exist ----
mkdir "$work/clone with space" "$work/bin"
clone="$work/clone with space"
tar -C "$source" --exclude=./build --exclude='./build-*' --exclude=./.git --exclude=./demo-out \
  -cf - . | tar -C "$clone" -xf -

cat >"$work/bin/apt-get" <<'STAND_IN'
#!/bin/sh
echo "apt-get DEBIAN_FRONTEND=${DEBIAN_FRONTEND:-} $*" >>"$CALLS"
STAND_IN
# Grants what it is asked where SUDO_WORKS is set.
cat >"$work/bin/sudo" <<'STAND_IN'
#!/bin/sh
echo "sudo $*" >>"$CALLS"
[ -n "${SUDO_WORKS:-}" ] || exit 1
[ "$1" = -n ] && shift
exec "$@"
STAND_IN
chmod 755 "$work/bin/apt-get" "$work/bin/sudo"
# A shell and tar are on every machine that runs this test.
printf '[build]\nbash\ncellocut-absent-package\n\n[test]\ntar\n[view]\n[bench]\n[web]\n' >"$work/missing.txt"
: >"$work/calls"
: >"$work/marker"
chmod 666 "$work/calls"

if [ "$(id -u)" -eq 0 ]; then
  chown -R nobody "$clone"
  as_user=(setpriv --reuid=nobody "--regid=$(id -g nobody)" --clear-groups)
else
  as_user=()
fi

# run PREFIX... -- VARIABLE=VALUE... COMMAND...: sets `code`, fills stdout, stderr and calls.
run() {
  local prefix=()
  while [ "$1" != -- ]; do
    prefix+=("$1")
    shift
  done
  shift
  : >"$work/calls"
  code=0
  (cd / && exec "${prefix[@]}" env -i "PATH=$work/bin:$PATH" CI=true "CALLS=$work/calls" "$@") \
    </dev/null >"$work/stdout" 2>"$work/stderr" || code=$?
}

nothing_written() {
  [ -z "$(find "$clone" -newer "$work/marker" -type f -print -quit)" ] && [ ! -e "$clone/build" ] &&
    [ ! -e "$clone/demo-out" ]
}
touch "$work/marker"

# ---- nothing missing --------------------------------------------------------------------------------
run "${as_user[@]}" -- "$clone/tools/setup" build test
[ "$code" -eq 0 ] || fail "nothing missing: exit $code instead of 0"
[ ! -s "$work/calls" ] || fail "nothing missing: apt-get or sudo was called"
[ ! -s "$work/stdout" ] || fail "nothing missing: printed something"

# ---- a package missing, no root ---------------------------------------------------------------------
for command in "tools/setup build test" tools/demo tools/test "tools/test --all" .ci/run; do
  read -r -a words <<<"$command"
  run "${as_user[@]}" -- "CELLOCUT_PACKAGES=$work/missing.txt" "$clone/${words[0]}" "${words[@]:1}"
  [ "$code" -eq 1 ] || fail "$command, package missing: exit $code instead of 1"
  [ "$(wc -l <"$work/stderr")" -eq 1 ] || fail "$command, package missing: not one line"
  grep -qx 'sudo apt-get update && sudo apt-get install -y --no-install-recommends cellocut-absent-package' \
    "$work/stderr" || fail "$command, package missing: not the line to paste"
  ! grep -q '^apt-get' "$work/calls" || fail "$command, package missing: apt-get was called"
  nothing_written || fail "$command, package missing: something was written"
done

# ---- a package missing, sudo without a password -----------------------------------------------------
run "${as_user[@]}" -- SUDO_WORKS=1 "CELLOCUT_PACKAGES=$work/missing.txt" "$clone/tools/setup" build
[ "$code" -eq 1 ] || fail "sudo: exit $code instead of 1, although the package is still missing"
grep -qx 'apt-get DEBIAN_FRONTEND=noninteractive install -y --no-install-recommends cellocut-absent-package' \
  "$work/calls" || fail "sudo: apt-get was not called as it should"
grep -q '^sudo -n ' "$work/calls" || fail "sudo: could have asked for a password"

# ---- a package missing, root ------------------------------------------------------------------------
if [ "$(id -u)" -eq 0 ]; then
  run -- "CELLOCUT_PACKAGES=$work/missing.txt" "$clone/tools/setup" build
  [ "$code" -eq 1 ] || fail "root: exit $code instead of 1, although the package is still missing"
  grep -qx 'apt-get DEBIAN_FRONTEND=noninteractive install -y --no-install-recommends cellocut-absent-package' \
    "$work/calls" || fail "root: apt-get was not called as it should"
  ! grep -q '^sudo' "$work/calls" || fail "root: sudo was called"
fi

# ---- wrong use --------------------------------------------------------------------------------------
run -- "$clone/tools/setup"
[ "$code" -eq 2 ] || fail "no group: exit $code instead of 2"
run -- "$clone/tools/setup" no-such-group
[ "$code" -ne 0 ] || fail "unknown group: accepted"
run -- "$clone/tools/test" --no-such-option
[ "$code" -eq 2 ] || fail "tools/test with an unknown option: exit $code instead of 2"

if [ "$failures" -ne 0 ]; then
  echo "$failures checks failed"
  exit 1
fi
echo "set-up: all checks passed"
