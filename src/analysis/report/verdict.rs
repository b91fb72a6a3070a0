// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether the shapes of the paper's results hold, judged from the figures.
//!
//! A finding can only be made by a predicate over numbers, and its sentence follows from what the predicate found: where a
//! shape does not hold, the sentence says so, and which of the costs made it so.

use serde::Serialize;

use super::figures::{Figures, STAGES};
use super::recipe::{MIRRORS, VIEWS};
use super::sections::Data;
use crate::device::stage::Stage;
use crate::method::options::Test;

/// The largest share of the time that correction takes in the paper (Conference, its tables 9.1 and 9.3): 86.7 of 508.1 ms.
const MOST_CORRECTION: f64 = 86.7 / 508.1;
/// The share of the wrong samples that correction may leave where thin things count as brought back.
const MOST_LEFT: f64 = 0.25;

/// A statement of the paper and what this run says to it. Made by [`judge`] alone.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    claim: &'static str,
    holds: Option<bool>,
    evidence: Vec<String>,
}

impl Finding {
    /// `None`: nothing was measured that it could be judged by.
    fn new(claim: &'static str, judged: Option<(bool, Vec<String>)>) -> Self {
        let (holds, evidence) = judged.map_or((None, Vec::new()), |(holds, evidence)| (Some(holds), evidence));
        Finding { claim, holds, evidence }
    }

    /// The statement.
    pub fn claim(&self) -> &'static str {
        self.claim
    }

    /// Whether it holds; none if it was not measured.
    pub fn holds(&self) -> Option<bool> {
        self.holds
    }

    /// The answer in words.
    pub fn answer(&self) -> &'static str {
        match self.holds {
            Some(true) => "holds",
            Some(false) => "does not hold",
            None => "was not measured",
        }
    }

    /// The numbers it was judged by, and why it does not hold where it does not.
    pub fn evidence(&self) -> &[String] {
        &self.evidence
    }
}

/// The shares of one scene as its samples grow.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// The scene.
    pub scene: String,
    /// Traced samples with 1, 4 and 16 samples a pixel.
    pub traced: [f64; 3],
    /// The share that failed each test, likewise.
    pub failed: [[f64; 7]; 3],
}

/// A step of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// What it is called.
    pub name: String,
    /// The share of reflective or traced pixels.
    pub share: f64,
    /// The share of traced pixels.
    pub traced: f64,
    /// The share that failed each test.
    pub failed: [f64; 7],
    /// Costs of the adaptive frame over that of the full one: their sum is 1 / speedup.
    pub costs: Vec<(&'static str, f64)>,
}

/// What correction costs in one scene.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrectionCost {
    /// The scene.
    pub scene: String,
    /// Its share of the adaptive frame's time.
    pub time: f64,
    /// Its share of the adaptive frame's work.
    pub work: f64,
}

/// Samples that show another object than full tracing, without and with correction.
#[derive(Debug, Clone, PartialEq)]
pub struct Thin {
    /// How it was drawn.
    pub drawn: String,
    /// Wrong samples without correction.
    pub without: u64,
    /// Wrong samples with it.
    pub with: u64,
}

impl Step {
    /// Full over adaptive.
    pub fn speedup(&self) -> f64 {
        1.0 / self.costs.iter().map(|(_, cost)| cost).sum::<f64>()
    }
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// The test of which the share of failures grew most from `before` to `after`, with its shares; none if none grew.
fn failed_more(before: &[f64; 7], after: &[f64; 7]) -> Option<String> {
    let more = |test: usize| after[test] - before[test];
    let worst = (0..7).max_by(|&a, &b| more(a).total_cmp(&more(b)))?;
    let name = Test::ALL[worst].name().to_uppercase();
    let shares = || format!("{name} failed at {} and then at {}", percent(before[worst]), percent(after[worst]));
    (more(worst) > 0.0).then(shares)
}

/// "Traced share falls with supersampling."
pub fn traced_share_falls(scenes: &[Sampled]) -> Finding {
    const CLAIM: &str = "More samples per pixel lower the share of traced samples.";
    let falls = |s: &Sampled| s.traced[0] > s.traced[1] && s.traced[1] > s.traced[2];
    let shares = |s: &Sampled| s.traced.map(percent).join(", ");
    let mut evidence: Vec<String> = scenes.iter().map(|s| format!("{}: {}", s.scene, shares(s))).collect();
    for s in scenes.iter().filter(|s| !falls(s)) {
        // The first step at which it does not fall, and the test that then failed most more often.
        let at = if s.traced[0] > s.traced[1] { 1 } else { 0 };
        evidence.push(match failed_more(&s.failed[at], &s.failed[at + 1]) {
            Some(test) => format!("Not in {}: {test}", s.scene),
            None => format!("Not in {}, although no test failed more often", s.scene),
        });
    }
    Finding::new(CLAIM, (!scenes.is_empty()).then(|| (scenes.iter().all(falls), evidence)))
}

/// Whether the speedup of `steps`, in the order of their shares, only grows (or only falls), and what stands against it.
fn monotone(claim: &'static str, steps: &[Step], grows: bool) -> Finding {
    let mut ordered: Vec<&Step> = steps.iter().collect();
    ordered.sort_by(|a, b| a.share.total_cmp(&b.share));
    let point = |s: &&Step| format!("{:.2} at {}", s.speedup(), percent(s.share));
    let mut evidence = vec![format!("Speedups: {}", ordered.iter().map(point).collect::<Vec<_>>().join(", "))];
    let mut holds = true;
    for pair in ordered.windows(2) {
        let [before, after] = pair else { continue };
        let right = if grows { after.speedup() > before.speedup() } else { after.speedup() < before.speedup() };
        if right {
            continue;
        }
        holds = false;
        // The cost that moved most against the claim.
        let moved = |at: usize| after.costs[at].1 - before.costs[at].1;
        let against = |at: usize| if grows { moved(at) } else { -moved(at) };
        let worst = (0..after.costs.len()).max_by(|&a, &b| against(a).total_cmp(&against(b))).unwrap_or(0);
        let tests = failed_more(&before.failed, &after.failed).map_or(String::new(), |test| format!("; {test}"));
        evidence.push(format!(
            "Not from {} to {}: {} went from {} to {} of the full frame\u{2019}s cost, and traced pixels from {} to {}{tests}",
            before.name,
            after.name,
            after.costs[worst].0,
            percent(before.costs[worst].1),
            percent(after.costs[worst].1),
            percent(before.traced),
            percent(after.traced)
        ));
    }
    Finding::new(claim, (steps.len() > 1).then_some((holds, evidence)))
}

/// In which currency a speedup is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    /// Frame time, on the device of the run.
    Time,
    /// Traversal work, which does not depend on the device.
    Work,
}

/// "Speedup grows with reflective pixels."
pub fn speedup_grows(by: By, steps: &[Step]) -> Finding {
    let claim = match by {
        By::Time => "The speedup by time grows with the share of reflective pixels.",
        By::Work => "The speedup by work grows with the share of reflective pixels.",
    };
    monotone(claim, steps, true)
}

/// "Speedup falls as the traced share grows."
pub fn speedup_falls(by: By, steps: &[Step]) -> Finding {
    let claim = match by {
        By::Time => "The speedup by time falls as the share of traced pixels grows.",
        By::Work => "The speedup by work falls as the share of traced pixels grows.",
    };
    monotone(claim, steps, false)
}

/// "Correction costs little": no more than in the paper's dearest scene.
pub fn correction_costs_little(scenes: &[CorrectionCost]) -> Finding {
    const CLAIM: &str =
        "Correction costs little: nowhere more of the frame than in the paper\u{2019}s dearest scene, 17.1 %.";
    let little = |s: &CorrectionCost| s.time <= MOST_CORRECTION && s.work <= MOST_CORRECTION;
    let mut evidence: Vec<String> = scenes
        .iter()
        .map(|s| format!("{}: {} of the time, {} of the work", s.scene, percent(s.time), percent(s.work)))
        .collect();
    for s in scenes.iter().filter(|s| !little(s)) {
        evidence.push(match s.work <= MOST_CORRECTION {
            true => format!(
                "Not in {} by time: its rays are only {} of the work, and the stage takes {} of the time on this device",
                s.scene,
                percent(s.work),
                percent(s.time)
            ),
            false => format!("Not in {}: its rays alone are {} of the work", s.scene, percent(s.work)),
        });
    }
    Finding::new(CLAIM, (!scenes.is_empty()).then(|| (scenes.iter().all(little), evidence)))
}

/// "Thin objects come back."
pub fn thin_objects_come_back(drawn: &[Thin]) -> Finding {
    const CLAIM: &str =
        "Thin objects come back: correction leaves at most a quarter of the samples that showed another object.";
    let back = |t: &Thin| t.without > 0 && t.with as f64 <= MOST_LEFT * t.without as f64;
    let mut evidence: Vec<String> = drawn
        .iter()
        .map(|t| format!("{}: {} wrong samples without correction, {} with it", t.drawn, t.without, t.with))
        .collect();
    for t in drawn.iter().filter(|t| !back(t)) {
        evidence.push(match t.without {
            0 => format!("Not with {}: nothing was lost that could come back", t.drawn),
            without => {
                format!("Not with {}: {} as many are wrong after it", t.drawn, percent(t.with as f64 / without as f64))
            }
        });
    }
    Finding::new(CLAIM, (!drawn.is_empty()).then(|| (drawn.iter().all(back), evidence)))
}

/// All findings of a run.
pub fn judge(data: &Data) -> Vec<Finding> {
    let scenes = &data.extent.scenes;
    let sampled = |scene: &String| {
        let figures = [1, 2, 4].map(|samples| data.get(&format!("samples/{samples}/{scene}")));
        let [Some(a), Some(b), Some(c)] = figures else { return None };
        let figures = [a, b, c];
        Some(Sampled { scene: scene.clone(), traced: figures.map(|f| f.traced), failed: figures.map(|f| f.failed) })
    };
    let sampled: Vec<Sampled> = scenes.iter().filter_map(sampled).collect();
    let mirrors: Vec<&Figures> = (1..=MIRRORS.len()).filter_map(|step| data.get(&format!("mirrors/{step}"))).collect();
    let views: Vec<&Figures> = (0..VIEWS.len()).filter_map(|view| data.get(&format!("views/{view}"))).collect();
    let mirror_name = |at: usize| format!("step {}", at + 1);
    let view_name = |at: usize| VIEWS[at].0.to_owned();
    let steps = |figures: &[&Figures], name: &dyn Fn(usize) -> String, share: fn(&Figures) -> f64, costs: Costs| {
        let step = |(at, f): (usize, &&Figures)| {
            let (name, share, costs) = (name(at), share(f), costs(f)?);
            Some(Step { name, share, traced: f.traced, failed: f.failed, costs })
        };
        figures.iter().enumerate().filter_map(step).collect::<Vec<Step>>()
    };
    let cost = |scene: &String| {
        let f = data.get(&format!("presets/balanced/{scene}"))?;
        let time = f.times.as_ref()?.share(Stage::Step4);
        Some(CorrectionCost { scene: scene.clone(), time, work: f.correction_work() })
    };
    let correction: Vec<CorrectionCost> = scenes.iter().filter_map(cost).collect();
    let thin = |samples: u32| {
        let wrong = |method: &str| data.get(&format!("rods/{method}/{samples}")).map(|f| f.wrong_object);
        Some(Thin { drawn: format!("rods, {samples}x{samples}"), without: wrong("off")?, with: wrong("balanced")? })
    };
    let thin: Vec<Thin> = [1, 4].into_iter().filter_map(thin).collect();
    vec![
        traced_share_falls(&sampled),
        speedup_grows(By::Time, &steps(&mirrors, &mirror_name, |f| f.reflective, time_costs)),
        speedup_grows(By::Work, &steps(&mirrors, &mirror_name, |f| f.reflective, work_costs)),
        speedup_falls(By::Time, &steps(&views, &view_name, |f| f.traced, time_costs)),
        speedup_falls(By::Work, &steps(&views, &view_name, |f| f.traced, work_costs)),
        correction_costs_little(&correction),
        thin_objects_come_back(&thin),
    ]
}

type Costs = fn(&Figures) -> Option<Vec<(&'static str, f64)>>;

/// Parts of the adaptive frame's work, over the full frame's.
fn work_costs(f: &Figures) -> Option<Vec<(&'static str, f64)>> {
    let share = |work: u64| work as f64 / f.full_work as f64;
    let [base, packed, corrected] = f.work_by_class;
    Some(vec![
        ("the work of base rays", share(base)),
        ("the work of packed rays", share(packed)),
        ("the work of correction", share(corrected)),
    ])
}

/// Parts of the adaptive frame's time, over the full frame's: scaled so that they add up to the median speedup.
fn time_costs(f: &Figures) -> Option<Vec<(&'static str, f64)>> {
    let times = f.times.as_ref()?;
    let scale = 1.0 / times.speedup.median / times.stages_ms.iter().sum::<f64>();
    let of = |stages: &[Stage]| stages.iter().map(|&stage| times.stages_ms[stage as usize]).sum::<f64>() * scale;
    Some(vec![
        ("the time of base rays", of(&[Stage::Step1])),
        ("the time of checks and packing", of(&[Stage::Step2a, Stage::Step2b, Stage::Step3a, Stage::Step3b])),
        ("the time of packed rays", of(&[Stage::Step2c, Stage::Step3c])),
        ("the time of correction", of(&[Stage::Step4])),
        ("the time outside of stages", times.stages_ms[STAGES - 1] * scale),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::report::published;

    fn steps(points: &[(f64, f64)]) -> Vec<Step> {
        let step = |&(share, speedup): &(f64, f64)| Step {
            name: format!("at {share}"),
            share,
            traced: 0.3 + 0.1 * share,
            failed: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.2 * share],
            costs: vec![("base", 0.25), ("packed", 1.0 / speedup - 0.25)],
        };
        points.iter().map(step).collect()
    }

    fn sampled(traced: [f64; 3], failed: [f64; 3]) -> Sampled {
        let failed = failed.map(|share| [0.0, 0.0, 0.0, 0.0, share, 0.0, 0.0]);
        Sampled { scene: "hall".into(), traced, failed }
    }

    #[test]
    fn the_papers_own_figures_have_the_papers_shapes() {
        let shares = |at: usize| {
            let tables = [published::ONE_SAMPLE, published::FOUR_SAMPLES, published::SIXTEEN_SAMPLES];
            sampled(tables.map(|table| table[at].traced), [0.0; 3])
        };
        let scenes: Vec<Sampled> = (0..6).map(shares).collect();
        assert_eq!(traced_share_falls(&scenes).holds(), Some(true));
        let sweep = |table: [published::SweepStep; 5]| steps(&table.map(|(share, .., speedup)| (share, speedup)));
        assert_eq!(speedup_grows(By::Time, &sweep(published::REFLECTIVE)).holds(), Some(true));
        assert_eq!(speedup_falls(By::Time, &sweep(published::TRACED)).holds(), Some(true));
        let cost = |at: usize| {
            let time = published::KERNEL_MS[at][7] / published::ONE_SAMPLE[at].ours_ms;
            CorrectionCost { scene: published::SCENES[at].into(), time, work: 0.0 }
        };
        assert_eq!(correction_costs_little(&(0..6).map(cost).collect::<Vec<_>>()).holds(), Some(true));
    }

    #[test]
    fn a_traced_share_that_does_not_fall_is_said_with_the_test_that_failed_more() {
        let scenes = [sampled([0.3, 0.28, 0.27], [0.1; 3]), sampled([0.3, 0.28, 0.29], [0.1, 0.1, 0.2])];
        let finding = traced_share_falls(&scenes);
        assert_eq!((finding.holds(), finding.answer()), (Some(false), "does not hold"));
        let last = finding.evidence().last().map(String::as_str);
        assert_eq!(last, Some("Not in hall: TX failed at 10.0 % and then at 20.0 %"));
        assert_eq!(traced_share_falls(&scenes[..1]).holds(), Some(true));
        // Standing still is not falling.
        let still = traced_share_falls(&[sampled([0.3, 0.3, 0.2], [0.1; 3])]);
        assert_eq!(still.holds(), Some(false));
        assert!(still.evidence().iter().any(|line| line.contains("no test failed more often")));
        assert_eq!(traced_share_falls(&[]).answer(), "was not measured");
    }

    #[test]
    fn a_speedup_that_goes_the_wrong_way_is_said_with_the_cost_that_did_it() {
        let growing = steps(&[(0.2, 1.5), (0.6, 1.9), (0.4, 1.7)]);
        assert_eq!(speedup_grows(By::Work, &growing).holds(), Some(true));
        let falls = speedup_falls(By::Work, &growing);
        assert_eq!(falls.holds(), Some(false));
        assert_eq!(falls.evidence()[0], "Speedups: 1.50 at 20.0 %, 1.70 at 40.0 %, 1.90 at 60.0 %");
        assert!(falls.evidence()[1].contains("packed went from 41.7 % to 33.8 %"), "{:?}", falls.evidence());
        let mixed = steps(&[(0.2, 1.5), (0.4, 1.4), (0.6, 1.9)]);
        let grows = speedup_grows(By::Time, &mixed);
        assert_eq!((grows.holds(), grows.evidence().len()), (Some(false), 2));
        assert_eq!(
            grows.evidence()[1],
            "Not from at 0.2 to at 0.4: packed went from 41.7 % to 46.4 % of the full frame\u{2019}s cost, and traced pixels \
             from 32.0 % to 34.0 %; GC failed at 4.0 % and then at 8.0 %"
        );
        assert_eq!(speedup_falls(By::Time, &mixed).holds(), Some(false));
        // Equal speedups neither grow nor fall.
        let level = steps(&[(0.2, 1.5), (0.4, 1.5)]);
        assert_eq!(speedup_grows(By::Work, &level).holds(), Some(false));
        assert_eq!(speedup_falls(By::Work, &level).holds(), Some(false));
        assert_eq!(speedup_falls(By::Work, &level[..1]).holds(), None);
    }

    #[test]
    fn dear_correction_is_said_with_what_makes_it_dear() {
        let cost = |time, work| CorrectionCost { scene: "hall".into(), time, work };
        assert_eq!(correction_costs_little(&[cost(0.17, 0.1)]).holds(), Some(true));
        let by_time = correction_costs_little(&[cost(0.17, 0.1), cost(0.18, 0.1)]);
        assert_eq!(by_time.holds(), Some(false));
        assert!(by_time.evidence()[2].contains("by time"), "{:?}", by_time.evidence());
        let by_work = correction_costs_little(&[cost(0.1, 0.2)]);
        assert_eq!(by_work.holds(), Some(false));
        assert!(by_work.evidence()[1].contains("alone are 20.0 %"), "{:?}", by_work.evidence());
        assert_eq!(correction_costs_little(&[]).holds(), None);
    }

    #[test]
    fn thin_objects_that_stay_away_are_said() {
        let thin = |without, with| Thin { drawn: "rods".into(), without, with };
        assert_eq!(thin_objects_come_back(&[thin(100, 25)]).holds(), Some(true));
        let stay = thin_objects_come_back(&[thin(100, 25), thin(100, 26)]);
        assert_eq!(stay.holds(), Some(false));
        assert!(stay.evidence()[2].contains("26.0 % as many"), "{:?}", stay.evidence());
        // Where nothing is lost nothing can come back: that is no success.
        assert_eq!(thin_objects_come_back(&[thin(0, 0)]).holds(), Some(false));
        assert_eq!(thin_objects_come_back(&[]).holds(), None);
    }
}
