//! First descents of parabolas and quartics: the time at which a gap between two surfaces closes.
//!
//! A custom boundary can find its touches with these functions: write the gap as a polynomial of the time
//! since the flight began, and ask for its first descent. A straight wall gives a parabola
//! ([`first_descent`]). A circle gives a polynomial of degree four ([`first_descent_of_quartic`]): the
//! difference of two squared distances.
//!
//! Both functions follow the stable event detection of Bannerman et al. (2014). Rounding leaves a gap
//! slightly open or slightly closed at each touch. A search that looked at the sign alone would either find
//! the same touch again immediately, or miss the next one and let the surfaces pass through each other.
//! Therefore, a closed gap counts only while it closes.

mod parabola;
mod quartic;

pub use parabola::first_descent;
pub use quartic::first_descent_of_quartic;
