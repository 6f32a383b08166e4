//! Faults, and samples that are not radiance.

use verdict::check::{Anomaly, Fault, Numerics};

use super::number::{radiance, seconds, trimmed};

/// What a submission did instead of answering.
pub fn fault(fault: &Fault) -> String {
    match fault {
        Fault::Panic(message) => format!("the program panicked: {message}"),
        Fault::Timeout(time) => format!("the program did not finish within {}", seconds(*time)),
        Fault::TooSlow(time) => {
            format!(
                "the program is too slow: it did not finish an eighth of its work within {}",
                seconds(*time)
            )
        }
        Fault::Crash(status) => format!("the program ended unexpectedly ({status})"),
        Fault::Waiting(time) => format!(
            "the program waited for {} without computing: it sleeps, or waits for a lock that is never released",
            seconds(*time)
        ),
        Fault::TooManyRays { rays, enough } => format!(
            "the program traces {} rays per path on average; {enough:.0} are enough for a path of this length even if it \
             samples every light at every bounce",
            trimmed(*rays, 1)
        ),
        Fault::TooFewRays => {
            "the program returns light for pixels without tracing a ray: images must come from paths"
                .to_owned()
        }
        Fault::Threads => {
            "the program starts threads, which no submission may do: each path is traced on the thread \
                           that calls `radiance`"
                .to_owned()
        }
        Fault::Malformed(what) => format!("the program's answer was malformed ({what})"),
    }
}

/// Samples that are not radiance, and the first of them; empty if there are none.
pub fn numerics(numerics: &Numerics) -> String {
    let counts = counts(numerics.non_finite, numerics.negative);
    match &numerics.first {
        Some(first) if !counts.is_empty() => format!("{counts}; the first is {}", sample(first)),
        _ => counts,
    }
}

/// "4 samples are NaN or infinite and 1 is negative".
pub(super) fn counts(non_finite: u64, negative: u64) -> String {
    let are = |number: u64| if number == 1 { "is" } else { "are" };
    let samples = |number: u64| if number == 1 { "sample" } else { "samples" };
    let of = |number: u64, what: &str| format!("{number} {} {} {what}", samples(number), are(number));
    match (non_finite, negative) {
        (0, 0) => String::new(),
        (_, 0) => of(non_finite, "NaN or infinite"),
        (0, _) => of(negative, "negative"),
        _ => format!("{} and {negative} {} negative", of(non_finite, "NaN or infinite"), are(negative)),
    }
}

/// "sample 5 of pixel (3, 4), with the value (NaN, 0, 0)".
fn sample(anomaly: &Anomaly) -> String {
    format!("{}, with the value {}", place(anomaly), radiance(anomaly.value.map(|value| value.0)))
}

/// "sample 5 of pixel (3, 4)".
pub(super) fn place(anomaly: &Anomaly) -> String {
    let Anomaly { pixel: [x, y], sample, .. } = anomaly;
    format!("sample {sample} of pixel ({x}, {y})")
}
