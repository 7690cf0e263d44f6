//! The border between sticking and sliding in the space of velocities.

/// The sine and cosine of the half angle α of the sticking sector.
///
/// In the scaled speeds $`x = v_n/\sqrt S`$, $`z = v_t/\sqrt V`$, a collision sticks for
/// $`|z| < x\tan\alpha`$. The vector (x cos φ, x sin φ, z) is isotropic, so $`\sin\alpha`$ is the probability
/// of sticking.
///
/// Formulas use $`s = \sin\alpha`$ and $`k = \cos\alpha`$ side by side. At large friction $`s`$ rounds to 1
/// and $`1 - s`$ would have no digits left; $`k^2/(1 + s)`$ is the same number with all its digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StickSlip {
    pub(super) sine: f64,
    pub(super) cosine: f64,
}

impl StickSlip {
    /// Creates the sector with tan α = κ·(opposite/adjacent). If `adjacent` is zero and κ is not, all
    /// collisions stick.
    #[inline]
    pub(super) fn new(friction: f64, opposite: f64, adjacent: f64) -> Self {
        if friction == 0.0 {
            return Self { sine: 0.0, cosine: 1.0 };
        }
        // Only the ratio of the sides matters. Friction above 1 divides one side instead of multiplying the
        // other, so that neither side overflows at any friction.
        let (opposite, adjacent) =
            if friction > 1.0 { (opposite, adjacent / friction) } else { (opposite * friction, adjacent) };
        let hypotenuse = libm::hypot(opposite, adjacent);
        Self { sine: opposite / hypotenuse, cosine: adjacent / hypotenuse }
    }

    /// Returns ⟨v_t²; stick⟩/V = s³.
    #[inline]
    pub(super) fn sticking_slip(self) -> f64 {
        self.sine * self.sine * self.sine
    }

    /// Returns ⟨v_n²; slide⟩/(S k²) = (1 − s)²(2 + s)/k² = k²(2 + s)/(1 + s)².
    #[inline]
    pub(super) fn sliding_closing(self) -> f64 {
        let above = 1.0 + self.sine;
        self.cosine * self.cosine * (2.0 + self.sine) / (above * above)
    }
}
