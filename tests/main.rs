//! What malus promises, asked of the whole of it: exact answers, the program, real rooms.
#![expect(clippy::unwrap_used, reason = "a failing test is to panic")]

// How a scene is run and held against an exact answer.
mod experiment;
// Light by images in flat mirrors and panes.
mod images;

// Closed rooms whose walls all emit: the answer is known at every point.
mod furnace;
// Light straight from lamps, and light conserved: cases in the spirit of CIE 171.
mod cie;
// The room of the paper against values from elsewhere.
mod unit_room;
// Scales, materials and geometry at the ends of their ranges.
mod extremes;
// Stokes vectors: chains of mirrors, analysers, frames.
mod polarisation;
// Counting in cells, the baseline.
mod direct;
// Where the flux goes.
mod ledger;
mod neighbours;
// Walks that correct a solution of the radiosity equation.
mod radiosity;
// Every technique weighed against every other: nothing is lost, nothing counted twice.
mod complete;
// Sheets that light passes.
mod panes;
// Diffusers under a clear coat.
mod coats;
// What a line of sight carries.
mod radiance;
// More components than a scene requires change nothing.
mod representations;
// The same bytes whatever the threads, the steps and the interruptions.
mod determinism;
// Studies of many variants.
mod sweep;
// Real rooms: the Blender office, and third-party rooms where they are at hand.
mod rooms;
// A furnished office against an independent program.
mod reference_office;
// Files, columns, exit statuses, and every way to get an input wrong.
mod cli;
