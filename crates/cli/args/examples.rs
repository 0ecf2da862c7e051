//! Examples below the help of each command.

pub const EXAMPLES: &str = "\
Examples:
  malus check office.toml                         what is in it, and what is wrong
  malus run office.toml                           compute it; results go to results/office
  malus run office.toml --relative-error 0.005    the same, to 0.5 % everywhere
  malus tradeoff office.toml                      how long which error takes
  malus analyse results/office/view.tiff          how a camera's picture is polarised

Exit status: 0 done, 1 the run failed, 2 bad arguments or a bad scene, 130 interrupted.";

pub const RUN_EXAMPLES: &str = "\
Examples:
  malus run office.toml -o results/glossy --set material.floor.a=0.6
  malus run office.toml --seconds 60 --threads 4
  malus run office.toml --samples 65536 --seed 7     repeats to the byte on any machine
  malus run office.toml --relative-error 1e-4 --resume        goes on after a reboot
  malus run office.toml --samples 1048576 --shard 3/8         one part of eight, for malus merge
  malus run office.toml --samples 1048576 --submit slurm --shards 8 --sbatch=--cpus-per-task=16 --wait

Results: sensors.csv (one row a sensor point), grids.csv (one row a sensor), a plan <sensor>.svg of each \
grid, and summary.json. A stop by error or by time prints the --samples that repeats it.

Exit status: 0 done, 1 the run failed, 2 bad arguments or a bad scene, 130 interrupted (Ctrl-C \
once: what is there is written and marked incomplete; twice: at once, without results).";

pub const MERGE_EXAMPLES: &str = "\
Examples:
  malus merge results/office                       all shards lie in one directory
  malus merge a/office b/office -o results/office  they were brought together from two machines

Scene or study is read again, from where it was when the shards were computed or from --scene, and has to be the same: the \
results have the bytes of one piece. Shards stay where they are.

Exit status: 0 done, 1 nothing can be written or a variant failed, 2 a shard is missing, there twice, unfinished, \
damaged or of another run.";

pub const SWEEP_EXAMPLES: &str = "\
Examples:
  malus sweep study-floor.toml                    every variant of the study; results go to results/study-floor
  malus sweep study.toml --samples 4096 --sensors
  malus sweep study.toml --resume                           goes on after a reboot
  malus sweep study.toml --samples 65536 --shard 3/8        one part of eight, for malus merge
  malus sweep study.toml --samples 65536 --submit slurm --shards 8 --wait

A study file names a scene and what varies in it, by the keys that --set takes:
  scene = \"office.toml\"
  [grid]                                          every combination
  \"material.Floor.a\" = [0, 0.2, 0.4]
  [list]                                          rows of a table whose header holds keys
  file = \"variants.csv\"
  [sample]                                        a seeded Latin hypercube
  count = 32
  \"material.Floor.n\" = { from = 1.3, to = 2.0 }
Several tables combine, each row of one with each of another. All variants take the walks that the stopping rule \
gives the base, the scene as it stands.

Results: variants.csv (a row a variant, written as it is finished), study.json (which variants differ, a ranking, \
sensitivities), a picture <sensor>-trade.svg of each sensor; with --parquet variants.parquet.

Exit status: 0 done, 1 a variant failed (the others are finished), 2 bad arguments, a bad scene or a bad study, 130 \
interrupted.";

pub const CHECK_EXAMPLES: &str = "\
Examples:
  malus check office.toml
  malus check office.toml --set material.floor.rho=0.2 --json

Exit status: 0 the scene can be run (there may be warnings), 2 bad arguments or a bad scene.";

pub const TRADEOFF_EXAMPLES: &str = "\
Examples:
  malus tradeoff office.toml
  malus tradeoff office.toml --budget 60 -o results/tradeoff
  malus tradeoff office.toml --set run.compare=[]    without the models computed beside

Results: tradeoff.csv (one row a setting and number of samples), tradeoff.svg (error against time), and the \
cheapest setting for 3 %, 1 %, 0.3 % and 0.1 % on stdout. Errors are against a reference of this command's own; \
the longer the budget, the smaller the errors that it can tell apart.

Exit status: 0 done, 1 nothing could be measured, 2 bad arguments or a bad scene, 130 interrupted (Ctrl-C once: \
what is measured is written; twice: at once, without results).";

pub const ANALYSE_EXAMPLES: &str = "\
Examples:
  malus analyse view.tiff                  how much is polarised, and along which axis
  malus analyse view.tiff --angle 90       what polarising sunglasses show
  malus analyse view.tiff --angle 0 --angle 45 -o filtered --exposure 1

Results: NAME-s0.png (what the eye sees), NAME-dolp.png (degree of linear polarisation), NAME-aolp.png (its \
angle) and for each angle NAME-filter-DEG.png and .tiff (radiance that passes, 32-bit floats). S0 and what \
passes a filter are shown with one exposure: unpolarised light looks half as bright through any filter.

Exit status: 0 done, 1 nothing can be written, 2 bad arguments or a bad picture.";

pub const BENCH_BVH_EXAMPLES: &str = "\
Examples:
  malus bench-bvh office.toml                      rates of all trees, with the scene's own sensors
  malus bench-bvh kitchen.obj --seconds 60 --json  of a mesh alone, measured longer
  malus bench-bvh office.toml --preset all         how much care in building is worth

wide is the tree that malus uses; bvh2 and cwbvh are those of the crate obvhs, for comparison. Answers are checked by \
trying every triangle; a wrong one of wide ends in exit status 1.

Exit status: 0 done, 1 wrong answers, 2 bad arguments or a bad file.";
