//! The kinetic floor: two ways to the mean energy change, the Monte Carlo average, and the paper's section
//! II.

mod mean_energy_change;
mod monte_carlo;
mod paper_energy_loss;
