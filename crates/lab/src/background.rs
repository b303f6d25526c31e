//! Work beside the window: on a desktop every task has a thread of its own; a page has no threads, and the window gives its
//! tasks a share of every frame. Tasks do not know which of the two calls them.

use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use web_time::Duration;

/// Longest computing time of a task before it looks at its requests.
pub(crate) const SHARE: Duration = Duration::from_millis(10);

/// When a task has to do something again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Next {
    /// After this time, or at the next request if that is earlier.
    After(Duration),
    /// At the next request.
    Asked,
}

/// Something to do beside the window.
pub(crate) trait Task {
    /// What it is asked for.
    type Request: Send + 'static;

    /// Takes a request.
    fn take(&mut self, request: Self::Request);

    /// Does what is due, for about this long at most.
    fn tick(&mut self, share: Duration) -> Next;

    /// Finishes: there will be no more requests.
    fn end(&mut self) {}
}

/// A task with its requests.
struct Turns<T: Task> {
    task: T,
    inbox: Receiver<T::Request>,
}

impl<T: Task> Turns<T> {
    /// Takes all requests, then does what is due; `None` where nobody is left who could ask, and all is finished.
    fn turn(&mut self, share: Duration) -> Option<Next> {
        loop {
            match self.inbox.try_recv() {
                Ok(request) => self.task.take(request),
                Err(TryRecvError::Empty) => return Some(self.task.tick(share)),
                Err(TryRecvError::Disconnected) => {
                    self.task.end();
                    return None;
                }
            }
        }
    }

    /// Goes on until nobody is left who could ask.
    #[cfg(not(target_family = "wasm"))]
    fn run(mut self) {
        while let Some(next) = self.turn(SHARE) {
            let request = match next {
                Next::Asked => self.inbox.recv().ok(),
                Next::After(time) => self.inbox.recv_timeout(time).ok(),
            };
            if let Some(request) = request {
                self.task.take(request);
            }
        }
    }
}

/// What does the work.
#[cfg(not(target_family = "wasm"))]
type Worker = Option<std::thread::JoinHandle<()>>;
/// What does the work.
#[cfg(target_family = "wasm")]
type Worker = Box<dyn FnMut(Duration) -> Option<Next>>;

/// A task at work.
pub(crate) struct Background<R> {
    requests: Option<Sender<R>>,
    worker: Worker,
}

impl<R: Send + 'static> Background<R> {
    /// Starts the task that `make` makes; `name` is that of its thread.
    #[cfg(not(target_family = "wasm"))]
    pub(crate) fn start<T>(name: &str, make: impl FnOnce() -> T + Send + 'static) -> Self
    where
        T: Task<Request = R>,
    {
        let (requests, inbox) = channel();
        let work = move || Turns { task: make(), inbox }.run();
        let worker = std::thread::Builder::new().name(name.to_owned()).spawn(work).ok();
        Self { requests: Some(requests), worker }
    }

    /// Starts the task that `make` makes.
    #[cfg(target_family = "wasm")]
    pub(crate) fn start<T>(_: &str, make: impl FnOnce() -> T) -> Self
    where
        T: Task<Request = R> + 'static,
    {
        let (requests, inbox) = channel();
        let mut turns = Turns { task: make(), inbox };
        Self { requests: Some(requests), worker: Box::new(move |share| turns.turn(share)) }
    }

    /// Sends a request; whether anybody will take it.
    pub(crate) fn ask(&self, request: R) -> bool {
        self.requests.as_ref().is_some_and(|requests| requests.send(request).is_ok())
    }

    /// Gives the task a share of a frame where it has no thread; when it needs the next.
    #[cfg_attr(not(target_family = "wasm"), expect(clippy::unused_self, clippy::needless_pass_by_ref_mut))]
    pub(crate) fn tick(&mut self, share: Duration) -> Next {
        #[cfg(target_family = "wasm")]
        return (self.worker)(share).unwrap_or(Next::Asked);
        #[cfg(not(target_family = "wasm"))]
        {
            let _ = share;
            Next::Asked
        }
    }

    /// Waits until the task has finished what it was asked for.
    pub(crate) fn finish(&mut self) {
        self.requests = None;
        #[cfg(not(target_family = "wasm"))]
        if let Some(thread) = self.worker.take() {
            // A panic of the thread has been printed already.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts down from what it is asked for, one at a tick.
    #[derive(Default)]
    struct Countdown {
        left: u32,
        asked: Vec<u32>,
        ended: Option<Sender<Vec<u32>>>,
    }

    impl Task for Countdown {
        type Request = u32;

        fn take(&mut self, request: u32) {
            self.asked.push(request);
            self.left += request;
        }

        fn tick(&mut self, _: Duration) -> Next {
            self.left = self.left.saturating_sub(1);
            if self.left == 0 { Next::Asked } else { Next::After(Duration::ZERO) }
        }

        fn end(&mut self) {
            if let Some(ended) = self.ended.take() {
                ended.send(std::mem::take(&mut self.asked)).expect("a listener");
            }
        }
    }

    #[test]
    fn a_turn_takes_all_requests_first() {
        let (requests, inbox) = channel();
        let mut turns = Turns { task: Countdown::default(), inbox };
        assert_eq!(turns.turn(SHARE), Some(Next::Asked));
        for request in [2, 1] {
            requests.send(request).expect("taken");
        }
        let next = [(); 3].map(|()| turns.turn(SHARE));
        assert_eq!(
            next,
            [Some(Next::After(Duration::ZERO)), Some(Next::After(Duration::ZERO)), Some(Next::Asked)]
        );
        assert_eq!(turns.task.asked, [2, 1]);
        drop(requests);
        assert_eq!(turns.turn(SHARE), None);
    }

    #[test]
    fn a_thread_takes_what_was_asked_before_it_ends() {
        let (sender, ended) = channel();
        let make = || Countdown { ended: Some(sender), ..Countdown::default() };
        let mut background = Background::start("countdown", make);
        assert!([3, 0, 2].map(|request| background.ask(request)).iter().all(|taken| *taken));
        background.finish();
        assert_eq!(ended.try_recv(), Ok(vec![3, 0, 2]));
        assert!(!background.ask(1));
    }
}
