//! Logs.

use recording::log::Log;

/// Moments that are read of a log.
const MOST: usize = 2000;

/// Any file is a log, or is refused in words; what it holds is moments of its cast.
pub fn mcap_log(data: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("log.mcap");
    std::fs::write(&path, data).expect("written");
    let Ok(log) = Log::open(&path) else { return };
    let (robots, edges) = (log.cast().members.len(), log.cast().edges.len());
    let mut middle = 0.0;
    for moment in log.moments().take(MOST) {
        let Ok(moment) = moment else { break };
        assert!(moment.snapshot.robots.len() <= robots && moment.edges.len() <= edges);
        middle = 0.5 * moment.snapshot.time;
    }
    drop(log.at(middle));
    drop(log.moments_from(middle).next());
}
