#!/usr/bin/env bash
# Installs what Pectora needs to be built, run and tested, from Debian 12's own packages. Run it again at any time.
set -euo pipefail

packages=(
  # To build with
  g++ cmake ninja-build pkg-config ca-certificates
  # Numbers and threads
  libeigen3-dev libtbb-dev libnanoflann-dev
  # DICOM (its tools keep CMake's find_package quiet)
  libgdcm-dev libgdcm-tools
  # Scripts, command line, texts, hashes
  liblua5.4-dev libcli11-dev libfmt-dev libspdlog-dev nlohmann-json3-dev libxxhash-dev
  # Pictures
  libcairo2-dev fonts-dejavu-core gnuplot-nox
  # The window
  libimgui-dev libglfw3-dev libepoxy-dev libegl1 libgl1-mesa-dri
  # Tests; CalculiX to compare the solid wall with, valgrind to count instructions, a display and a hand for the window
  libgtest-dev calculix-ccx valgrind xvfb xdotool
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query --show --showformat='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  echo "All packages are there."
  exit 0
fi

as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
echo "Installing: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" > /dev/null
