//! Other load on the machine.

use std::hint::black_box;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;

/// Threads that compute and walk through memory until this is dropped.
pub(super) struct Load {
    stop: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

/// Numbers that each thread walks through: 8 MB, more than a core's own caches hold.
const NUMBERS: usize = 1 << 20;

impl Load {
    pub(super) fn start(threads: usize) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let spawn = |_| {
            let stop = Arc::clone(&stop);
            std::thread::spawn(move || {
                let mut numbers: Vec<u64> = (0..NUMBERS as u64).collect();
                let mut place = 1;
                while !stop.load(Ordering::Relaxed) {
                    for _ in 0..NUMBERS / 16 {
                        place = (place * 5 + 12_345) % NUMBERS;
                        numbers[place] = numbers[place].wrapping_mul(6_364_136_223_846_793_005) + 1;
                    }
                    black_box(&numbers);
                }
            })
        };
        let threads = (0..threads).map(spawn).collect();
        Self { stop, threads }
    }
}

impl Drop for Load {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        // A thread of this load cannot panic.
        self.threads.drain(..).for_each(|thread| drop(thread.join()));
    }
}
