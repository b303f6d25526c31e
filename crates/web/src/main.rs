//! The lab on a web page: `scripts/web` builds this program for WebAssembly, where it draws into the page's canvas.

fn main() {
    #[cfg(target_family = "wasm")]
    lab::open_on_page("lab");
    #[cfg(not(target_family = "wasm"))]
    println!("this program runs on a web page, which scripts/web builds");
}
