//! A report as one file of HTML: nothing is fetched from anywhere, figures, pictures, films and the font are in it.

use crate::claim::FigureClaim;
use crate::figure::{Report, ReportFigure, ReportTable};
use base64::Engine;
use std::fmt::Write;

/// The report; `font` (OpenType) is what its text is set in.
pub fn page(report: &Report, font: &[u8]) -> String {
    let mut html = String::new();
    let style = include_str!("page.css").replace("FONT", &data("font/otf", font));
    let title = escape(&report.title);
    let _ = write!(
        html,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<style>\n{style}</style>\n</head>\n<body>\n\
         <header>\n<h1>{title}</h1>\n<p>{}</p>\n</header>\n<main>\n",
        escape(&report.lead)
    );
    verdicts(&mut html, report);
    html.push_str("<section class=\"figures\">\n");
    report.items.iter().enumerate().for_each(|(index, item)| figure(&mut html, item, index));
    html.push_str("</section>\n");
    films(&mut html, report);
    report.tables.iter().for_each(|each| table(&mut html, each));
    if !report.left_out.is_empty() {
        html.push_str("<section>\n<h2>Left out</h2>\n<ul>\n");
        for text in &report.left_out {
            let _ = writeln!(html, "<li>{}</li>", escape(text));
        }
        html.push_str("</ul>\n</section>\n");
    }
    html.push_str("</main>\n<footer>\n<dl>\n");
    for [name, value] in &report.versions {
        let _ = writeln!(html, "<div><dt>{}</dt><dd>{}</dd></div>", escape(name), escape(value));
    }
    html.push_str("</dl>\n</footer>\n</body>\n</html>\n");
    html
}

/// What figures are called in the report.
fn name(item: &ReportFigure, index: usize) -> String {
    let number = item.stem.strip_prefix("figure-").and_then(|n| n.parse::<u32>().ok());
    format!("Figure {}", number.unwrap_or(index as u32 + 1))
}

/// What is so and what is not, first of all.
fn verdicts(html: &mut String, report: &Report) {
    let (all, fail) = (report.claims().count(), report.claims().filter(|c| !c.holds).count());
    if all == 0 {
        return;
    }
    let holds = all - fail;
    let _ = writeln!(html, "<section>\n<h2>What holds</h2>\n<p><b>{holds} of {all}</b> statements hold.</p>");
    if fail > 0 {
        let _ = writeln!(
            html,
            "<p class=\"no\">{fail} {} not:</p>\n<ul class=\"claims\">",
            if fail == 1 { "does" } else { "do" }
        );
        for (index, item) in report.items.iter().enumerate() {
            for each in item.claims.iter().filter(|c| !c.holds) {
                claim(html, each, Some(&name(item, index)));
            }
        }
        html.push_str("</ul>\n");
    }
    html.push_str("</section>\n");
}

fn claim(html: &mut String, claim: &FigureClaim, of: Option<&str>) {
    let (class, mark, word) = if claim.holds { ("yes", "✓", "so") } else { ("no", "✗", "not so") };
    let of = of.map_or_else(String::new, |of| format!("{of}: "));
    let values = if claim.values.is_empty() {
        escape(&claim.quantity)
    } else {
        format!("{}: {}; wanted: {}", escape(&claim.quantity), escape(&claim.found()), escape(&claim.wanted))
    };
    let _ = writeln!(
        html,
        "<li class=\"{class}\"><span class=\"mark\" title=\"{word}\">{mark}</span> {}<b>{}</b> \
         <span class=\"values\">{values}.</span></li>",
        escape(&of),
        escape(&claim.claim)
    );
}

fn figure(html: &mut String, item: &ReportFigure, index: usize) {
    let wide = if item.picture.is_some() { " class=\"wide\"" } else { "" };
    let (name, caption) = (name(item, index), escape(&item.caption));
    let _ = writeln!(html, "<figure id=\"{}\"{wide}>", escape(&item.stem));
    if let Some(png) = &item.picture {
        let _ = writeln!(html, "<img alt=\"{caption}\" src=\"{}\">", data("image/png", png));
    } else {
        html.push_str(&item.svg);
    }
    let _ = writeln!(html, "<figcaption><b>{name}.</b> {caption}");
    if !item.claims.is_empty() {
        html.push_str("<ul class=\"claims\">\n");
        item.claims.iter().for_each(|each| claim(html, each, None));
        html.push_str("</ul>\n");
    }
    html.push_str("</figcaption>\n</figure>\n");
}

fn films(html: &mut String, report: &Report) {
    if report.films.is_empty() {
        return;
    }
    html.push_str("<section class=\"films\">\n<h2>Films</h2>\n");
    for film in &report.films {
        let _ = writeln!(
            html,
            "<figure><video controls loop muted playsinline src=\"{}\"></video><figcaption>{}</figcaption></figure>",
            data("video/mp4", &film.mp4),
            escape(&film.caption)
        );
    }
    html.push_str("</section>\n");
}

fn table(html: &mut String, table: &ReportTable) {
    let _ = writeln!(
        html,
        "<section class=\"table\">\n<table{}>\n<caption>{}</caption>\n<thead><tr>",
        if table.words { " class=\"words\"" } else { "" },
        escape(&table.caption)
    );
    for cell in &table.head {
        let _ = write!(html, "<th>{}</th>", escape(cell));
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for row in &table.rows {
        html.push_str("<tr>");
        for cell in row {
            let _ = write!(html, "<td>{}</td>", escape(cell));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody>\n</table>\n</section>\n");
}

fn data(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes))
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claim::ClaimSubject;
    use crate::figure::ReportFilm;

    fn report() -> Report {
        let about = |quantity| ClaimSubject { figure: "figure-07", claim: "a < b & c", quantity, unit: "m" };
        let claims = vec![
            FigureClaim::falls(about("x"), &[("a", 2.0), ("b", 1.0)]),
            FigureClaim::falls(about("y"), &[("a", 1.0), ("b", 2.0)]),
        ];
        Report {
            title: "One & all".to_owned(),
            items: vec![
                ReportFigure::new("figure-07", "caption", "<svg></svg>".to_owned(), String::new())
                    .with(claims),
            ],
            films: vec![ReportFilm {
                file: "a.mp4".to_owned(),
                caption: "film".to_owned(),
                mp4: vec![1, 2, 3],
            }],
            ..Report::default()
        }
    }

    #[test]
    fn what_is_not_so_is_said_first_and_in_red() {
        let html = page(&report(), b"font");
        assert!(html.contains("<b>1 of 2</b>") && html.contains("class=\"no\""));
        let (first, figure) = (html.find("not so").expect("told"), html.find("<figure").expect("a figure"));
        assert!(first < figure);
        assert!(
            html.contains("Figure 7") && html.contains("a &lt; b &amp; c") && html.contains("One &amp; all")
        );
    }

    #[test]
    fn nothing_is_fetched() {
        let html = page(&report(), b"font");
        for word in ["http://", "https://", "src=\"/", "@import", "<script", "<link"] {
            assert!(!html.contains(word), "{word}");
        }
        assert!(html.contains("data:video/mp4;base64,AQID"));
    }
}
