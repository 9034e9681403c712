//! Parts of the work for several machines.

use std::env;
use std::str::FromStr;

use crate::cli::Refused;

/// Every `n`-th drawing from the `k`-th on; `k` counts from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shard {
    k: u64,
    n: u64,
}

/// A shard as it is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ShardName {
    Numbers(Shard),
    /// What the variables of a Slurm job array say.
    Slurm,
}

impl Shard {
    /// All drawings.
    pub(super) const ALL: Self = Self { k: 0, n: 1 };

    /// Whether it has the drawing of this number, which counts from 0.
    pub(super) fn contains(self, drawing: usize) -> bool {
        drawing as u64 % self.n == self.k
    }
}

impl FromStr for ShardName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "slurm" {
            return Ok(Self::Slurm);
        }
        let numbers = text.split_once('/').and_then(|(k, n)| {
            Some((k.trim().parse::<u64>().ok()?, n.trim().parse::<u64>().ok()?))
        });
        match numbers {
            Some((k, n)) if (1..=n).contains(&k) => Ok(Self::Numbers(Shard { k: k - 1, n })),
            _ => Err("expected K/N with K from 1 to N, as in 2/8, or slurm".to_owned()),
        }
    }
}

impl ShardName {
    /// The shard that it stands for.
    pub(super) fn shard(self) -> Result<Shard, Refused> {
        match self {
            Self::Numbers(shard) => Ok(shard),
            Self::Slurm => {
                let failed = |message: String| Refused::Failed(message.into());
                of_array(|name| env::var(name).ok()).map_err(failed)
            }
        }
    }
}

/// The shard of one task of a Slurm job array.
fn of_array(variable: impl Fn(&str) -> Option<String>) -> Result<Shard, String> {
    let number = |name: &str| -> Result<Option<u64>, String> {
        let name = format!("SLURM_ARRAY_TASK_{name}");
        let Some(text) = variable(&name) else { return Ok(None) };
        let number =
            text.trim().parse().map_err(|_| format!("{name} is not a number: `{text}`"))?;
        Ok(Some(number))
    };
    let needed = |name: &str| -> Result<u64, String> {
        number(name)?.ok_or_else(|| {
            format!("--shard slurm: SLURM_ARRAY_TASK_{name} is not set; run it with sbatch --array")
        })
    };
    let (id, min, n) = (needed("ID")?, needed("MIN")?, needed("COUNT")?);
    let max = needed("MAX")?;
    let step = number("STEP")?.unwrap_or(1).max(1);
    let offset = id.checked_sub(min).filter(|offset| offset % step == 0);
    let is_whole = max.checked_sub(min).is_some_and(|length| length / step + 1 == n);
    match offset.map(|offset| offset / step) {
        Some(k) if is_whole && k < n => Ok(Shard { k, n }),
        _ => Err(format!(
            "--shard slurm needs an array without gaps, as in --array=1-8; this one has {n} tasks \
             from {min} to {max}, and this is task {id}"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::{Shard, ShardName, of_array};

    #[test]
    fn every_drawing_is_in_exactly_one_shard() {
        for n in 1..6u64 {
            for drawing in 0..40 {
                let shards = (1..=n).map(|k| format!("{k}/{n}").parse());
                let has = |shard: &Result<ShardName, String>| match shard {
                    Ok(ShardName::Numbers(shard)) => shard.contains(drawing),
                    _ => panic!("a shard"),
                };
                assert_eq!(shards.filter(has).count(), 1);
            }
        }
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        for text in ["", "0/3", "4/3", "1", "1/0", "-1/2", "a/b", "1/2/3", "Slurm"] {
            assert!(text.parse::<ShardName>().is_err(), "{text}");
        }
    }

    /// Variables ID, MIN, MAX, COUNT and STEP.
    fn array(numbers: [&str; 5]) -> Result<Shard, String> {
        let names = ["ID", "MIN", "MAX", "COUNT", "STEP"];
        of_array(|name| {
            let place = names.iter().position(|end| name == format!("SLURM_ARRAY_TASK_{end}"))?;
            (!numbers[place].is_empty()).then(|| numbers[place].to_owned())
        })
    }

    #[test]
    fn tasks_of_an_array_are_its_shards() {
        assert_eq!(array(["5", "1", "8", "8", "1"]), Ok(Shard { k: 4, n: 8 }));
        assert_eq!(array(["0", "0", "0", "1", ""]), Ok(Shard { k: 0, n: 1 }));
        // --array=10-30:5 has the tasks 10, 15, 20, 25 and 30; --array=0-9:4 has 0, 4 and 8.
        assert_eq!(array(["25", "10", "30", "5", "5"]), Ok(Shard { k: 3, n: 5 }));
        assert_eq!(array(["8", "0", "8", "3", "4"]), Ok(Shard { k: 2, n: 3 }));
    }

    #[test]
    fn an_array_with_gaps_is_refused() {
        // --array=1,2,7, --array=1-4,9-12
        assert!(array(["7", "1", "7", "3", "1"]).is_err());
        assert!(array(["9", "1", "12", "8", "1"]).is_err());
        assert!(array(["3", "0", "8", "3", "4"]).is_err());
        assert!(array(["9", "1", "8", "8", "1"]).is_err());
        let unset = array(["", "1", "8", "8", "1"]).expect_err("no task");
        assert!(unset.contains("SLURM_ARRAY_TASK_ID is not set"), "{unset}");
        let odd = array(["x", "1", "8", "8", "1"]).expect_err("no task");
        assert!(odd.contains("is not a number"), "{odd}");
    }
}
