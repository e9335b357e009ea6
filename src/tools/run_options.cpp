#include "src/tools/run_options.hpp"

#include "src/export/export_formats.hpp"

namespace desert_sim {

namespace {

void add_certificate(Options& o) {
  o.topic("certify", "Whether this machine gives the hashes that all give")
      .flag(
          "certify",
          "in place of a run: make the runs of config/certificate.json, some at a time, and tell which hash "
          "is another one (--backend, --threads: of each run, 1 by default)");
  for (const char* other : {"steps", "duration", "set", "seed", "script", "all-raster-formats", "out",
                            "cross-section", "export", "film", "checkpoint", "resume", "replay", "migrate",
                            "describe", "describe-view", "describe-processes", "pipeline"})
    o.excludes(other);
  o.option("only", "WORD", "only runs with WORD in their name")
      .needs("certify")
      .option("jobs", "N", "runs at a time (default: processors / threads)")
      .needs("certify")
      .option("table", "FILE", "another certificate than that of the package")
      .needs("certify")
      .option("record", "FILE",
              "in place of a comparison: write the certificate with the hashes of this machine; without "
              "--table also with a run of each scenario that has none")
      .needs("certify");
}

}  // namespace

Options run_options() {
  Options o("desert_run", "Runs a scenario without ROS and without a window.");
  o.positional("SCENARIO", "a YAML file, or the name of an installed scenario, such as barchan", 0)
      .topic("run", "Length and settings of a run")
      .option("steps", "N", "steps to run (default: the scenario's run.steps); with --resume: the last step")
      .essential()
      .option("duration", "T",
              "in place of --steps: simulated time until the end, in s or with a unit, such as 24a (ms, s, "
              "min, h, d, a)")
      .essential()
      .excludes("steps")
      .option("set", "PATH=VALUE", "override a key of the scenario; may be repeated")
      .essential()
      .option("seed", "S", "same as --set seed=S")
      .essential()
      .option("script", "FILE",
              "what happens when: a YAML list of parameters that are set and commands, as in run.timeline")
      .essential()
      .option("backend", "B", "auto (default), cpu or cuda")
      .essential()
      .option("threads", "N", "threads of the CPU backend")
      .flag("quiet", "print no progress")
      .flag("all-raster-formats",
            "read rasters of every format that GDAL reads, also what names other files or hosts (VRT, WMS, "
            "/vsi paths), not only GeoTIFF, ESRI ASCII, ENVI, PNG, EXR and USGS DEM")
      .topic("output", "Rasters, tables and summary of a run")
      .option("out", "DIR", "write rasters, pictures and summary.json to folder DIR")
      .essential()
      .option("every", "N", "also write them every N steps, to DIR/step_NNNNNNNN")
      .essential()
      .needs("out")
      .option("snapshots", "N",
              "in place of --every: write them about N times, at even distances and at the end")
      .needs("out")
      .excludes("every")
      .option("format", "F",
              "geotiff (default): a raster a layer in DIR and in each DIR/step_NNNNNNNN; netcdf: all layers "
              "at the start, every N steps and at the end in one file, DIR/terrain.nc")
      .needs("out")
      .option("cross-section", "NAME=X1,Y1,X2,Y2",
              "add up the sand that the wind carries across this line, to the left of its way, in "
              "summary.json; may be repeated")
      .option("probe", "X,Y", "write a time series of this point to DIR/probes.csv; may be repeated")
      .needs("out")
      .option("probe-every", "N", "steps from line to line (default 1)")
      .needs("probe")
      .option("micro-relief", "X1,Y1,X2,Y2,resolution=R",
              "write the surface between these corners with ripples and bumps (section micro_relief) to "
              "DIR/micro_relief.tif, a point each R metres (default 0.05); may be repeated")
      .needs("out")
      .option("export", "FILE",
              "write the terrain at the end for other programs, by the ending of FILE; may be repeated: " +
                  describe_export_formats())
      .topic("film", "Films, pictures and plots")
      .option("film", "FILE",
              "film the run from above: an .mp4 (needs ffmpeg), a folder of pictures, or one .png of the end")
      .essential()
      .option("film-every", "N", "steps from picture to picture (default: such that there are about 250)")
      .needs("film")
      .option("view", "KEY=VALUE",
              "where the camera stands and what it shows; may be repeated; --describe-view lists them")
      .needs("film")
      .option("plot", "FILE",
              "draw a PNG of areas by material and plants by species over the steps of --every (needs "
              "python3 with matplotlib)")
      .needs("out")
      .topic("resume", "Checkpoints, and journals of live runs")
      .option("checkpoint", "FILE", "save the state to FILE at the end")
      .essential()
      .option("checkpoint-every", "N", "also save it every N steps")
      .needs("checkpoint")
      .option("resume", "FILE",
              "start from a checkpoint, also without SCENARIO, with --set of parameters that can change "
              "while a simulation runs")
      .essential()
      .excludes("script")
      .option("replay", "JOURNAL",
              "apply the commands of a journal; without --steps, run as many steps as it has")
      .topic("describe", "What is printed or rewritten in place of a run")
      .option("migrate", "FILE",
              "write the present keys in a scenario file of an earlier version: sand.model, micro_relief; "
              "comments stay")
      .flag("describe", "print all parameters as markdown")
      .flag("describe-view", "print the keys of --view as markdown")
      .flag("describe-processes", "print the table of processes as markdown")
      .flag("pipeline",
            "print the processes of a step of the scenario in order, with layers and memory, and how many "
            "steps a run takes")
      .footer(
          "Exit status: 0; 1 if a material was lost or gained, or a hash of --certify\n"
          "differs; 2 for invalid input; 3 for a failure at run time; 130 after Ctrl-C,\n"
          "SIGTERM or SIGHUP. Outputs are written except for 2 and 3.");
  add_certificate(o);
  return o;
}

}  // namespace desert_sim
