#!/usr/bin/env bash
# Of conda/meta.yaml: conda build calls it in a copy of the sources.
set -euo pipefail
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$PREFIX" -DCMAKE_PREFIX_PATH="$PREFIX" \
  -DDESERT_PORTABLE=ON -DDESERT_WITH_CUDA=OFF -DDESERT_WITH_RVIZ=OFF -DCATKIN_ENABLE_TESTING=OFF \
  -DPYTHON_EXECUTABLE="$PYTHON"
cmake --build build
cmake --install build
