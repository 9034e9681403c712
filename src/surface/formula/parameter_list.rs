//! Parameters of formulas that take one value after another.

use super::parameter::{Parameter, ParameterError};

/// The maximum number of values, and of combinations of the values of several lists.
pub const MAX_VALUES: usize = 32;

/// The last value of evenly spaced ones is the end of their range if the rest is less than this part of a
/// step, so that 0, 0.1 … ends with 0.3 although the sum is rounded.
const REST: f64 = 1e-9;

/// A name and the values that it takes one after another.
///
/// ```
/// use hiddenline::ParameterList;
///
/// let a = ParameterList::new("a", [1.0, 2.0, 3.0])?;
/// assert_eq!(a, ParameterList::evenly("a", 1.0, 3.0, 1.0)?);
/// # Ok::<(), hiddenline::errors::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterList {
    parameters: Vec<Parameter>,
}

impl ParameterList {
    /// A parameter with given values.
    ///
    /// # Errors
    /// As for [`Parameter::new`]; or there are no values, or more than [`MAX_VALUES`].
    pub fn new(name: &str, values: impl IntoIterator<Item = f64>) -> Result<Self, ParameterError> {
        let parameters = values.into_iter().map(|value| Parameter::new(name, value));
        Self::of(parameters.collect::<Result<_, _>>()?)
    }

    /// A parameter with the values from `from` to `to`, `step` apart; a shorter last step is left out.
    ///
    /// # Errors
    /// As for [`new`](Self::new); or the step does not lead from `from` to `to`.
    pub fn evenly(name: &str, from: f64, to: f64, step: f64) -> Result<Self, ParameterError> {
        let steps = (to - from) / step;
        if !(steps >= 0.0 && steps.is_finite()) {
            return Err(ParameterError::Step(name.to_owned()));
        }
        let n = (steps + REST).floor();
        if n >= MAX_VALUES as f64 {
            return Err(ParameterError::TooMany);
        }
        let ends = (steps - n).abs() < REST;
        let value = |k: u32| match f64::from(k) {
            k if k == n && ends => to,
            k => from + k * step,
        };
        Self::new(name, (0..=n as u32).map(value))
    }

    /// One parameter's values, as they are.
    ///
    /// # Errors
    /// There are no values, or more than [`MAX_VALUES`].
    #[doc(hidden)]
    pub fn of(parameters: Vec<Parameter>) -> Result<Self, ParameterError> {
        match parameters.len() {
            0 => Err(ParameterError::NoValues),
            1..=MAX_VALUES => Ok(Self { parameters }),
            _ => Err(ParameterError::TooMany),
        }
    }

    /// The name, as [`Parameter::name`] gives it.
    pub fn name(&self) -> &str {
        self.parameters.first().map_or("", Parameter::name)
    }

    /// Each combination of a value of each list; the last list's values change first. One that is empty
    /// for no lists.
    ///
    /// # Errors
    /// A name is in two lists, or there are more than [`MAX_VALUES`] combinations.
    pub fn combinations(lists: &[Self]) -> Result<Vec<Vec<Parameter>>, ParameterError> {
        let mut all = vec![Vec::new()];
        for (k, list) in lists.iter().enumerate() {
            if lists[..k].iter().any(|other| other.name() == list.name()) {
                return Err(ParameterError::Twice(list.name().to_owned()));
            }
            if all.len() * list.parameters.len() > MAX_VALUES {
                return Err(ParameterError::TooMany);
            }
            let with = |before: &Vec<Parameter>| {
                let before = before.clone();
                let one = |last: &Parameter| [&before[..], std::slice::from_ref(last)].concat();
                list.parameters.iter().map(one).collect::<Vec<_>>()
            };
            all = all.iter().flat_map(with).collect();
        }
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(list: &ParameterList) -> Vec<f64> {
        list.parameters.iter().map(Parameter::value).collect()
    }

    #[test]
    fn even_steps_end_where_they_should_although_sums_are_rounded() {
        let of = |from, to, step| ParameterList::evenly("a", from, to, step).map(|a| values(&a));
        assert_eq!(of(0.0, 1.0, 0.25), Ok(vec![0.0, 0.25, 0.5, 0.75, 1.0]));
        let tenths = of(0.0, 0.3, 0.1).expect("values");
        assert_eq!((tenths.len(), tenths[3]), (4, 0.3));
        assert_eq!(of(0.0, 1.0, 0.4), Ok(vec![0.0, 0.4, 0.8]));
        assert_eq!(of(3.0, 1.0, -1.0), Ok(vec![3.0, 2.0, 1.0]));
        assert_eq!(of(2.0, 2.0, 1.0), Ok(vec![2.0]));
        assert_eq!(of(0.0, 31.0, 1.0).map(|a| a.len()), Ok(32));
        assert_eq!(of(0.0, 32.0, 1.0), Err(ParameterError::TooMany));
        for (from, to, step) in
            [(0.0, 1.0, 0.0), (0.0, 1.0, -1.0), (0.0, f64::NAN, 1.0), (0.0, f64::INFINITY, 1.0)]
        {
            assert!(of(from, to, step).is_err(), "{from}:{to}:{step}");
        }
        assert!(of(0.0, 1e300, 1e-300).is_err());
    }

    #[test]
    fn lists_multiply_and_the_last_one_changes_first() {
        let a = ParameterList::new("a", [1.0, 2.0]).expect("values");
        let b = ParameterList::new("b", [3.0, 4.0, 5.0]).expect("values");
        let all = ParameterList::combinations(&[a.clone(), b]).expect("combinations");
        let numbers: Vec<Vec<f64>> =
            all.iter().map(|all| all.iter().map(Parameter::value).collect()).collect();
        let expected = [[1.0, 3.0], [1.0, 4.0], [1.0, 5.0], [2.0, 3.0], [2.0, 4.0], [2.0, 5.0]];
        assert_eq!(numbers, expected);
        assert_eq!(ParameterList::combinations(&[]), Ok(vec![vec![]]));
        let many = ParameterList::evenly("b", 1.0, 17.0, 1.0).expect("values");
        let too_many = ParameterList::combinations(&[a.clone(), many]);
        assert_eq!(too_many, Err(ParameterError::TooMany));
        let twice = ParameterList::combinations(&[a.clone(), a]);
        assert_eq!(twice, Err(ParameterError::Twice("a".to_owned())));
    }
}
