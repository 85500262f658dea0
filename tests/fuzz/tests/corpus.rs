//! Every target over its corpus, and over mutations of it.
//!
//! `PYDSLREP_FUZZ=100000 cargo test --release -p pydslrep-fuzz` tries that many mutations of each target.

#![allow(clippy::unwrap_used, reason = "a broken corpus fails the test")]

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};

use pydslrep_fuzz::{TARGETS, Target};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const MUTATIONS: usize = 200;

fn corpus(target: &Target) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target.name);
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files.into_iter().map(|file| fs::read(file).unwrap()).collect()
}

/// Runs a target; a failure prints its input.
fn run(target: &Target, data: &[u8]) {
    if let Err(panic) = catch_unwind(AssertUnwindSafe(|| (target.run)(data))) {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let file = folder.join(format!("{}-failed", target.name));
        fs::write(&file, data).unwrap();
        #[expect(clippy::print_stderr, reason = "it says how to repeat the failure")]
        {
            eprintln!("{} fails; the input is in {}", target.name, file.display());
        }
        resume_unwind(panic);
    }
}

#[test]
fn the_corpus_breaks_nothing() {
    for target in &TARGETS {
        let inputs = corpus(target);
        assert!(!inputs.is_empty(), "{} has no corpus", target.name);
        for data in inputs {
            run(target, &data);
        }
    }
}

#[test]
fn nor_do_mutations_of_it() {
    let count = std::env::var("PYDSLREP_FUZZ").map_or(MUTATIONS, |number| number.parse().unwrap());
    for target in &TARGETS {
        let inputs = corpus(target);
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for _ in 0..count {
            let mut data = inputs[below(&mut random, inputs.len())].clone();
            let other = &inputs[below(&mut random, inputs.len())];
            for _ in 0..=below(&mut random, 4) {
                mutate(&mut data, other, &mut random);
            }
            run(target, &data);
        }
    }
}

/// A number from 0 up to a limit, which it does not reach unless that is 0.
fn below(random: &mut ChaCha8Rng, limit: usize) -> usize {
    usize::try_from(random.next_u32()).unwrap() % limit.max(1)
}

/// Changes, removes, repeats or inserts some bytes, or takes some of another input.
fn mutate(data: &mut Vec<u8>, other: &[u8], random: &mut ChaCha8Rng) {
    let begin = below(random, data.len() + 1);
    let end = (begin + below(random, 24)).min(data.len());
    let replacement: Vec<u8> = match below(random, 6) {
        0 => Vec::new(),
        1 => data[begin..end].iter().map(|byte| byte ^ (1 << below(random, 8))).collect(),
        2 => (0..below(random, 9)).map(|_| random.next_u32().to_le_bytes()[0]).collect(),
        3 => data[begin..end].repeat(2 + below(random, 9)),
        4 => vec![[0, 0xff, b'{', b'"', b'9'][below(random, 5)]; 1 + below(random, 20)],
        _ => {
            let from = below(random, other.len() + 1);
            other[from..(from + below(random, 60)).min(other.len())].to_vec()
        }
    };
    data.splice(begin..end, replacement);
}
