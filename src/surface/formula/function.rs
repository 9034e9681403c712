//! The functions of one number.

/// A function of one number, by its name in formulas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Asinh,
    Acosh,
    Atanh,
    Sqrt,
    Cbrt,
    Exp,
    Ln,
    Log2,
    Log10,
    Abs,
    Sign,
    Floor,
    Ceil,
    Round,
    Trunc,
    Fract,
    Sinc,
    Erf,
    Gamma,
    J0,
    J1,
    Y0,
    Y1,
}

impl Function {
    /// The function itself. Calling it costs no dispatch, so take it once for many numbers.
    pub(super) fn evaluator(self) -> fn(f64) -> f64 {
        match self {
            Self::Sin => libm::sin,
            Self::Cos => libm::cos,
            Self::Tan => libm::tan,
            Self::Asin => libm::asin,
            Self::Acos => libm::acos,
            Self::Atan => libm::atan,
            Self::Sinh => libm::sinh,
            Self::Cosh => libm::cosh,
            Self::Tanh => libm::tanh,
            Self::Asinh => libm::asinh,
            Self::Acosh => libm::acosh,
            Self::Atanh => libm::atanh,
            // IEEE 754 requires correctly rounded square roots, so the result is the same everywhere.
            Self::Sqrt => f64::sqrt,
            Self::Cbrt => libm::cbrt,
            Self::Exp => libm::exp,
            Self::Ln => libm::log,
            Self::Log2 => libm::log2,
            Self::Log10 => libm::log10,
            Self::Abs => f64::abs,
            Self::Sign => |t| if t == 0.0 { 0.0 } else { t.signum() },
            Self::Floor => libm::floor,
            Self::Ceil => libm::ceil,
            Self::Round => libm::round,
            Self::Trunc => libm::trunc,
            Self::Fract => |t| t - libm::floor(t),
            Self::Sinc => |t| if t == 0.0 { 1.0 } else { libm::sin(t) / t },
            Self::Erf => libm::erf,
            Self::Gamma => libm::tgamma,
            Self::J0 => libm::j0,
            Self::J1 => libm::j1,
            Self::Y0 => libm::y0,
            Self::Y1 => libm::y1,
        }
    }
}
