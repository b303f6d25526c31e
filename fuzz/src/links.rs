//! Links.

use crate::scenes::in_words;
use scene::{Link, Scene};

/// Longest text of the scene of a link, bytes: what links unpack to, and what they set in it.
const MOST_TEXT: usize = 3_000_000;

/// Any text is a link, or is refused in words; one that is accepted is written out to text that is the same link, leads to a
/// scene or is refused in words, and the scene is one without the link too.
pub fn links(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let link: Link = match text.parse() {
        Ok(link) => link,
        Err(error) => return in_words(&error.to_string()),
    };
    let written = link.to_string();
    let again: Link = written.parse().unwrap_or_else(|error| panic!("{error}: {written}"));
    assert!(again == link, "what was written out is another link: {written}");
    let opened = match link.open() {
        Ok(opened) => opened,
        Err(error) => return in_words(&error.to_string()),
    };
    assert!(opened.text.len() < MOST_TEXT, "{} bytes of scene", opened.text.len());
    let scene =
        Scene::parse(&opened.text, &opened.home, &[]).unwrap_or_else(|faults| panic!("{faults}")).scene;
    assert!(scene == opened.scene, "the text of the link is another scene: {}", opened.text);
    let short = link.shortened();
    assert!(
        short.open().is_ok_and(|short| short.scene == scene),
        "the shorter link leads elsewhere: {short}"
    );
    if let Ok(found) = Link::to_text(&opened.text, short.name()) {
        let found = found.open().unwrap_or_else(|error| panic!("{error}: {found}"));
        assert!(found.scene == scene, "the link to the text leads elsewhere: {}", opened.text);
    }
}
