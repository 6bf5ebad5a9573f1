#!/usr/bin/env bash
# install-dependencies.sh [simulation|tests [--peers]]: installs the Debian 12 packages that SonoVDB needs to build and run;
# those of the simulator alone, or those of the tests, too. Returns at once when all are there. With --peers, programs of
# others from PyPI that read what is written, and simulators (2.5 GB), go into build/peers, too; tests that ask them are
# skipped without.
set -euo pipefail

packages=(
  # tools
  g++ cmake ninja-build ccache
  # the simulator; libopenvdb-dev needs libboost-iostreams-dev without saying so
  libopenvdb-dev libboost-iostreams-dev libnanovdb-dev libembree-dev libtbb-dev libglm-dev libnifti-dev libteem-dev libdlpack-dev
  nlohmann-json3-dev libpugixml-dev zlib1g-dev libisal-dev libdeflate-dev libdcmtk-dev libhdf5-dev
  libopenigtlink-dev libgl-dev
)
if [[ ${1:-} != simulation ]]; then
  packages+=(
    # ParaView 5.11 and what the modules below the plugin ask for (see Plugin/SonoVDBModules.cmake)
    paraview paraview-dev python3-paraview python3-numpy qtbase5-dev libqt5svg5-dev libqt5opengl5-dev qttools5-dev
    qtxmlpatterns5-dev-tools libfreetype-dev
    # the pictures that are written
    libopenimageio-dev
  )
fi
if [[ ${1:-} == tests ]]; then
  packages+=(
    libgtest-dev libbenchmark-dev openimageio-tools libopenvdb-tools xvfb openmpi-bin python3-mpi4py
    python3-xlib python3-pyqt5 clang-format doxygen
    # readers of the learning study
    python3-pil python3-nibabel
    # registers phases
    elastix
    # read what is written
    dcmtk dicom3tools python3-pydicom python3-h5py openigtlink-examples
  )
fi
# As the tests know them.
peers=(highdicom==0.28.2 dcmqi==1.5.7 SimpleITK==2.5.7 pyigtl==0.3.4 PyMUST==0.1.9 zea==0.1.8 "jax[cpu]==0.10.2" pyuff_ustb h5py)
# Simulators that the study's part `peers` measures beside PyMUST and zea.
peers+=(FastSIMUS==0.0.1 esdiva==0.3.0 k-Wave-python==0.6.2)

fail()
{
  echo "$(basename "$0"): $*" >&2
  exit 1
}

install_peers()
{
  local folder
  folder="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/build/peers"
  local wanted="${peers[*]}"
  if [[ -f $folder/installed && $(< "$folder/installed") == "$wanted" ]]; then
    echo "The programs of others are in $folder."
    return
  fi
  /usr/bin/python3 -m venv --clear "$folder"
  "$folder/bin/pip" install --quiet --no-cache-dir "${peers[@]}"
  echo "$wanted" > "$folder/installed"
}

with_peers=
if [[ ${2:-} == --peers ]]; then
  [[ $1 == tests ]] || fail "--peers goes with tests."
  with_peers=yes
  packages+=(python3-venv)
fi

command -v dpkg-query > /dev/null || fail "dpkg-query was not found; this script knows Debian 12 only."

declare -A installed=()
while read -r name status; do
  if [[ $status == installed ]]; then
    installed[$name]=1
  fi
done < <(dpkg-query --show --showformat='${Package} ${db:Status-Status}\n' "${packages[@]}" 2> /dev/null || true)

missing=()
for package in "${packages[@]}"; do
  if [[ -z ${installed[$package]:-} ]]; then
    missing+=("$package")
  fi
done
if ((${#missing[@]} == 0)); then
  echo "All ${#packages[@]} packages are installed."
  [[ -z $with_peers ]] || install_peers
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  command -v sudo > /dev/null || fail "run it as root or install sudo, to install: ${missing[*]}"
  as_root=(sudo)
fi

"${as_root[@]}" apt-get update

unknown=()
for package in "${missing[@]}"; do
  policy="$(LC_ALL=C apt-cache policy "$package")"
  if [[ ! $policy =~ "Candidate: "[^\(] ]]; then
    unknown+=("$package")
  fi
done
if ((${#unknown[@]} > 0)); then
  fail "no package source offers ${unknown[*]}; add Debian 12 (bookworm) main to the sources of apt."
fi

"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "${missing[@]}"
[[ -z $with_peers ]] || install_peers
