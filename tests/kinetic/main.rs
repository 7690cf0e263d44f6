//! The kinetic floor: two ways to the mean energy change, the Monte Carlo average, and the paper's section
//! II.

#[path = "../support/cases.rs"]
mod cases;
mod mean_energy_change;
#[path = "../support/measured.rs"]
mod measured;
mod monte_carlo;
mod paper_energy_loss;
