# shellcheck shell=bash
# Sourced by scripts/test for --fuzz: libFuzzer on what the programs read, with sanitizers, in a build of its own.

FUZZERS=(scenario journal rover_journal checkpoint raster bag message elevation rover planner display)

# Where this build has put a program.
built_program() { # NAME
  find "$BUILD" -name "$1" -type f -perm -u+x | head -n 1
}

# Files to begin with: those of the repository, and checkpoints of small scenarios, which this build writes.
fuzz_seeds() { # NAME FOLDER
  local name
  mkdir -p "$2"
  [[ ! -d $DESERT_ROOT/test/fuzz/corpus/$1 ]] || cp "$DESERT_ROOT/test/fuzz/corpus/$1"/* "$2"
  case $1 in
    scenario) cp "$DESERT_ROOT"/config/scenarios/*.yaml "$2" ;;
    journal) cp "$DESERT_ROOT/test/src/simulation/recorded/journal.yaml" "$2" ;;
    raster) cp "$DESERT_ROOT/config/scenarios/dem_example.asc" "$2" ;;
    checkpoint)
      for name in nebkha oasis_cycle beach; do
        "$(built_program desert_run)" "$DESERT_ROOT/config/scenarios/$name.yaml" --set grid.width=12 \
          --set grid.height=10 --backend cpu --steps 3 --quiet --checkpoint "$2/$name.ck" >/dev/null
      done ;;
    message | elevation | bag | rover | planner | display) # random bytes: each is some messages
      for name in {1..20}; do
        LC_ALL=C awk -v seed="$name" 'BEGIN { srand(seed); for (n = 0; n < 100 * seed; ++n) printf "%c", 256 * rand() }' \
          >"$2/random_$name"
      done ;;
  esac
}

# One fuzzer; its log is FOLDER/NAME.log, and what it has found FOLDER/found/NAME-*.
run_fuzzer() { # NAME SECONDS FOLDER
  fuzz_seeds "$1" "$3/$1"
  # Libraries of others keep memory until the end, or lose it (rosbag, of a bag that it refuses): no leak of ours. GDAL
  # reserves what a header asks for, and takes it only when it is filled: the limit is what is resident.
  ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 "$(built_program "fuzz_$1")" "-max_total_time=$2" -timeout=20 \
    -rss_limit_mb=2048 -malloc_limit_mb=1000000 -max_len=65536 -detect_leaks=0 -print_final_stats=1 \
    "-artifact_prefix=$3/found/$1-" "$3/$1" >"$3/$1.log" 2>&1
}

# Each fuzzer for so many minutes, as many at a time as there are processors. Fails if one has found something.
run_fuzzers() { # MINUTES
  local name seconds folder=$BUILD/fuzz jobs=${DESERT_JOBS:-$(nproc)} failed=0
  seconds=$(awk -v minutes="$1" 'BEGIN { print int(minutes * 60) }')
  mkdir -p "$folder/found"
  unset ASAN_OPTIONS UBSAN_OPTIONS # libFuzzer wants the reports on its standard error
  say "fuzzing ${FUZZERS[*]} for $1 minutes each"
  for name in "${FUZZERS[@]}"; do
    while (($(jobs -rp | wc -l) >= jobs)); do wait -n || failed=1; done
    run_fuzzer "$name" "$seconds" "$folder" &
  done
  while (($(jobs -rp | wc -l))); do wait -n || failed=1; done
  for name in "${FUZZERS[@]}"; do
    say "$name: $(grep -c . "$folder/$name.log") lines of log, $(sed -n 's/^stat::number_of_executed_units: *//p' "$folder/$name.log") inputs tried"
  done
  if ((failed)) || [[ -n $(ls "$folder/found") ]]; then
    tail -n 30 "$folder"/*.log
    fail "a fuzzer has found something, or could not run: $folder/found has $(find "$folder/found" -type f | wc -l) inputs"
  fi
}
