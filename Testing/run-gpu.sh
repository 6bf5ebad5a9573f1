#!/usr/bin/env bash
# The tests and the benchmark of the GPU, for a machine with a GPU and a driver but none of the simulator's libraries.
#   run-gpu.sh pack [PART] here: builds, and packs programs and libraries (or one of them) into build-gpu
#   run-gpu.sh test        there: the tests of the GPU against the CPU
#   run-gpu.sh benchmark   there: prints the stage `gpu` of the figures
#   run-gpu.sh instructions  there, where ncu is: what an image's kernels issue, and how long that takes at least
#   run-gpu.sh filters     there: what VTK costs around the simulator; `pack filters` packs it, with VTK's libraries
#   run-gpu.sh views [FOLDER]  there: a drag drawn in ParaView's views, the last pictures into the folder; `pack views` packs ParaView
#                          for it, with a display server, for there is none
#   run-gpu.sh window      there: the stages `drawn` and `gui` on two of that machine's cores, its GPU left aside; `pack window`
#                          packs ParaView's window, beside what `pack views` packs
#   run-gpu.sh dataset FILE [FOLDER [PART PARTS]]  there: writes a data set (the same pack), or takes it image by image
#   run-gpu.sh study [FOLDER]  there: run time against error on the GPU, tables and report in the folder (build-gpu/study)
#   run-gpu.sh peers [FOLDER]  there: programs of others on the same scenes, tables and report in the folder (build-gpu/peers);
#                          `pack peers` packs them for Python 3.12 with JAX, CuPy, SciPy, scikit-learn, OpenCV and h5py
#   run-gpu.sh sanitize    there: the checks of compute-sanitizer on small scenes
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
pack="$root/build-gpu"
bin="$root/build-simulation/bin"
unpacked="${TMPDIR:-/tmp}/sonovdb-gpu"

archive()
{
  tar -C "$2" -c . | xz -T0 -3 > "$pack/$1.tar.xz"
  rm -rf "$2"
}

pack_programs()
{
  "$root/Testing/build-preset.sh" simulation GpuTests GpuBenchmark study_curves
  local work
  work="$(mktemp -d)"
  cp "$bin/GpuTests" "$bin/GpuBenchmark" "$bin/study_curves" "$root"/Data/*.csv "$work"
  cp -r "$root/Data/probes" "$work"
  archive programs "$work"
}

# All but the C library and the loader, which must be those of the machine.
libraries_of()
{
  ldd "$1" | awk '$3 ~ /^\// {print $3}' | grep -vE '/(libc|libm|libdl|libpthread|librt)\.so' | sort -u |
    xargs -I{} cp -L {} "$2"
}

pack_libraries()
{
  local work
  work="$(mktemp -d)"
  libraries_of "$bin/GpuTests" "$work"
  libraries_of "$bin/study_curves" "$work"
  archive libraries "$work"
}

pack_filters()
{
  local build="$root/build"
  "$root/Testing/build-preset.sh" release FilterBenchmark DataSetBenchmark
  local work
  work="$(mktemp -d)"
  mkdir -p "$work/lib" "$work/share"
  cp "$build/bin/FilterBenchmark" "$build/bin/DataSetBenchmark" "$root"/Data/*.csv "$work"
  cp -rL "$build/share/sonovdb" "$work/share"
  cp "$build"/lib/libvtkSonoFilters.so* "$work/lib"
  libraries_of "$build/bin/FilterBenchmark" "$work/lib"
  archive filters "$work"
}

# ParaView's Python, and what of it the stage `renders` loads here.
pack_views()
{
  "$root/Testing/build-preset.sh" release SonoVDB vtkSonoFiltersPython vtkSonoWidgetsPython
  local work packages=/usr/lib/python3/dist-packages plugin=lib/paraview-5.11/plugins/SonoVDB/SonoVDB.so file
  work="$(mktemp -d)"
  mkdir -p "$work/lib" "$work/bin" "$work/python" "$work/dri" "$work/share"
  cat > "$work/mapped.py" << END
import runpy
runpy.run_path("$root/Testing/Benchmark/stages/renders.py")
with open("/proc/self/maps") as maps, open("$work/mapped", "w") as mapped:
    mapped.write("\n".join(sorted({line.split()[-1] for line in maps if "/" in line and ".so" in line})))
END
  SONOVDB_PLUGIN="$root/build/$plugin" PYTHONPATH="$root/build/lib/python3/dist-packages" \
    xvfb-run -a -s "-screen 0 1400x900x24" pvpython --no-mpi "$work/mapped.py"
  cp "$(readlink -f "$(command -v pvpython)")" "$work/bin/pvpython"
  cp "$(command -v Xvfb)" "$(command -v xkbcomp)" "$work/bin"
  cp -r /usr/share/X11/xkb "$work/share"
  cp "$root/build/$plugin" "$root"/build/lib/libvtkSono*.so "$work/lib"
  cp -r "$root/build/lib/python3/dist-packages/sonovdb" "$work/python"
  cp -rL "$root/build/share/sonovdb" "$work/share"
  (cd /usr/lib/python3.11 && find . -name '*.py' -not -path '*/test/*' -o -path './lib-dynload/*') |
    tar -C /usr/lib/python3.11 -c -T - | tar -C "$work/python" -x
  (cd "$packages" && find paraview vtkmodules -name '*.py') | tar -C "$packages" -c -T - | tar -C "$work/python" -x
  while read -r file; do
    case "$file" in
      "$packages"/*) (cd "$packages" && cp --parents "${file#"$packages"/}" "$work/python") ;;
      */dri/*) cp "$file" "$work/dri" ;;
    esac
  done < "$work/mapped"
  # Mesa's own beside them: what NVIDIA's library for X looks for at run time comes with it.
  for file in "$work"/bin/* "$work"/dri/* "$work"/lib/SonoVDB.so $(grep "^$packages\|/libGLX_mesa" "$work/mapped"); do
    libraries_of "$file" "$work/lib"
  done
  rm "$work"/mapped*
  archive views "$work"
}

# What ParaView's window needs beside its Python: Qt's plugins, fonts, and what the stages' hands are made of.
pack_window()
{
  local work file
  work="$(mktemp -d)"
  mkdir -p "$work/lib" "$work/bin" "$work/fonts" "$work/python"
  cp "$(readlink -f "$(command -v paraview)")" "$work/bin/paraview"
  cp -r /usr/lib/*/qt5/plugins "$work/qt"
  (cd "$work/qt" && find . -name '*.so' | grep -vE '/(libqxcb|libqxcb-glx-integration|libqsvg|libqsvgicon|libqico)\.so$' | xargs rm)
  cp -rL /etc/fonts "$work/fonts/etc"
  cp -r /usr/share/fonts/truetype/dejavu "$work/fonts"
  (cd /usr/lib/python3/dist-packages && cp -r Xlib six.py "$work/python")
  for file in "$work/bin/paraview" $(find "$work/qt" -name '*.so'); do
    libraries_of "$file" "$work/lib"
  done
  cp -L /usr/lib/*/libGLX_mesa.so.0 "$work/lib"
  tar -tf "$pack/views.tar.xz" | sed -n 's,^\./lib/\([^/]*\)$,\1,p' | (cd "$work/lib" && xargs rm -f) # the other pack brings them
  archive window "$work"
}

# Those that run on a GPU, as install-dependencies.sh knows them, and what they need beside what the machine has. The others
# would only repeat there what the CPU's study has measured.
pack_peers()
{
  local work
  work="$(mktemp -d)"
  python3 -m pip install --quiet --no-compile --no-deps --target "$work" --python-version 3.12 --only-binary=:all: \
    --platform manylinux2014_x86_64 --platform manylinux_2_28_x86_64 \
    zea==0.1.8 keras==3.15.1 optree==0.20.0 \
    FastSIMUS==0.0.1 array-api-compat==1.16.0 array-api-extra==0.11.0 beartype==0.23.1 jaxtyping==0.3.11 \
    wadler-lindig==0.1.8 pydantic==2.14.4 pydantic-core==2.50.5 typing-inspection==0.4.5 annotated-types==0.8.0 \
    k-Wave-python==0.6.2 deprecated==1.2.18 wrapt==2.5.2
  archive peers "$work"
}

unpack()
{
  local part
  rm -rf "$unpacked"
  for part in "$@"; do
    mkdir -p "$unpacked/$part"
    if command -v xz > /dev/null; then
      tar -C "$unpacked/$part" -xJf "$pack/$part.tar.xz"
    else
      python3 -m tarfile -e "$pack/$part.tar.xz" "$unpacked/$part"
    fi
  done
}

# From here on: what `pack views` packed, with the machine's display server where there is one.
with_paraview()
{
  local views="$unpacked/views"
  export PATH="$views/bin:$PATH" LD_LIBRARY_PATH="$views/lib:$views/lib/blas:${LD_LIBRARY_PATH:-}" LIBGL_DRIVERS_PATH="$views/dri"
  export PYTHONHOME="$views/python" PYTHONPATH="$views/python:$views/python/lib-dynload"
  export SONOVDB_DATA_DIR="$views/share/sonovdb" SONOVDB_PLUGIN="$views/lib/SonoVDB.so"
  # Where the display server looks for them, whatever the environment says.
  [ -e /usr/bin/xkbcomp ] || cp "$views/bin/xkbcomp" /usr/bin
  [ -e /usr/share/X11/xkb ] || { mkdir -p /usr/share/X11 && cp -r "$views/share/xkb" /usr/share/X11; }
  [ -e /usr/lib/x86_64-linux-gnu/dri ] || cp -r "$views/dri" /usr/lib/x86_64-linux-gnu/dri
}

with_libraries()
{
  SONOVDB_DATA_DIR="$unpacked/programs" LD_LIBRARY_PATH="$unpacked/libraries" "$@"
}

case "${1:-}" in
  pack)
    mkdir -p "$pack"
    for part in ${2:-programs libraries}; do
      "pack_$part"
    done
    ls -l "$pack"
    ;;
  test)
    unpack programs libraries
    with_libraries "$unpacked/programs/GpuTests"
    ;;
  benchmark)
    unpack programs libraries
    with_libraries "$unpacked/programs/GpuBenchmark"
    ;;
  instructions)
    unpack programs libraries
    metrics=smsp__inst_executed.sum,gpu__time_duration.sum
    metrics+=,device__attribute_multiprocessor_count,device__attribute_clock_rate
    with_libraries ncu --metrics "$metrics" --kernel-name-base function --csv -c 200 "$unpacked/programs/GpuBenchmark" |
      python3 "$root/Testing/gpu-instructions.py"
    ;;
  filters)
    unpack filters
    SONOVDB_DATA_DIR="$unpacked/filters" LD_LIBRARY_PATH="$unpacked/filters/lib" "$unpacked/filters/FilterBenchmark"
    ;;
  views)
    unpack views
    with_paraview
    Xvfb :99 -screen 0 1400x900x24 +extension GLX &
    trap 'kill %1' EXIT
    sleep 3
    DISPLAY=:99 __GLX_VENDOR_LIBRARY_NAME=nvidia SONOVDB_RENDERED="${2:-}" \
      pvpython --no-mpi "$root/Testing/Benchmark/stages/renders.py"
    ;;
  window)
    unpack views window
    window="$unpacked/window"
    sed -i "s,/usr/share/fonts,$window/fonts," "$window/fonts/etc/fonts.conf"
    # Two that share no core.
    cores="$(lscpu -p=CPU,CORE | awk -F, '!/^#/ && !seen[$2]++ {print $1}' | head -2 | paste -sd,)"
    with_paraview
    export PATH="$window/bin:$PATH" LD_LIBRARY_PATH="$LD_LIBRARY_PATH:$window/lib" PYTHONPATH="$PYTHONPATH:$window/python"
    export QT_PLUGIN_PATH="$window/qt" FONTCONFIG_PATH="$window/fonts/etc" CUDA_VISIBLE_DEVICES= XDG_CACHE_HOME=/dev/null
    export __GLX_VENDOR_LIBRARY_NAME=mesa LP_NUM_THREADS=2
    for stage in drawn gui; do
      taskset -c "$cores" pvpython --no-mpi "$root/Testing/Benchmark/stages/$stage.py"
    done
    ;;
  dataset)
    unpack filters
    LD_LIBRARY_PATH="$unpacked/filters/lib" "$unpacked/filters/DataSetBenchmark" "${@:2}"
    ;;
  study)
    unpack programs libraries
    with_libraries "$unpacked/programs/study_curves" "${2:-$pack/study}" error_gpu report
    ;;
  peers)
    unpack programs libraries peers
    # The machine's own Python, with these packages, and without the simulator's libraries.
    mkdir -p "$unpacked/python/bin"
    cat > "$unpacked/python/bin/python" << END
#!/bin/sh
export PYTHONPATH='$unpacked/peers' LD_LIBRARY_PATH='${LD_LIBRARY_PATH:-}'
exec '$(command -v python3)' "\$@"
END
    chmod +x "$unpacked/python/bin/python"
    with_libraries env SONOVDB_DATA_DIR="$root/Data" SONOVDB_PEERS="$unpacked/python" \
      "$unpacked/programs/study_curves" "${2:-$pack/peers}" peers report
    ;;
  sanitize)
    unpack programs libraries
    for tool in memcheck racecheck initcheck synccheck; do
      with_libraries compute-sanitizer --tool "$tool" --error-exitcode 9 "$unpacked/programs/GpuTests" \
        --gtest_filter='GpuSmall.*'
    done
    ;;
  *)
    sed -n '2,16s/^# *//p' "$0" >&2
    exit 2
    ;;
esac
