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
    let (robots, edges) = (log.fleet().robots.len(), log.fleet().edges.len());
    let mut middle = 0.0;
    for record in log.records().take(MOST) {
        let Ok(record) = record else { break };
        assert!(record.snapshot.robots.len() <= robots && record.edges.len() <= edges);
        middle = 0.5 * record.snapshot.time;
    }
    drop(log.at(middle));
    drop(log.records_from(middle).next());
}
