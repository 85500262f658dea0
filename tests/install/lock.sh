# Sourced by scripts that install something: `wait_for_turn` before looking what is missing, because tests run at the same
# time. A script that another one calls shares its turn.
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

wait_for_turn() {
  if [ -z "${PYDSLREP_INSTALLS:-}" ] && command -v flock >/dev/null; then
    mkdir -p "$repository/target"
    exec 9>"$repository/target/install.lock"
    flock 9
    export PYDSLREP_INSTALLS=1
  fi
}
