//! Numbers and words as figures write them.

use serde_json::Value;

/// A number as its shortest decimal, without a fraction where it is whole; with an exponent where that is shorter.
pub fn shown(x: f64) -> String {
    if !x.is_finite() {
        return if x.is_nan() { "–".to_string() } else { (if x > 0.0 { "∞" } else { "−∞" }).to_string() };
    }
    let (plain, power) = (format!("{x}"), format!("{x:e}"));
    if power.len() < plain.len() { power } else { plain }
}

/// A cell that is no number, as a word.
pub fn of_cell(cell: &Value) -> String {
    match cell {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// A number to three significant digits.
pub fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return shown(x);
    }
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    if (1e-3..1e5).contains(&rounded.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// A share in percent; what is neither none nor all says neither.
pub fn percent(share: f64) -> String {
    match share {
        x if x.is_nan() => "–".to_string(),
        x if x > 0.0 && x < 0.005 => "<1%".to_string(),
        x if x < 1.0 && x > 0.995 => ">99%".to_string(),
        x => format!("{:.0}%", 100.0 * x),
    }
}

/// A share in percent, in a sentence: two digits of what it is from none or from all.
pub fn in_percent(share: f64) -> String {
    let from_end = 100.0 * share.min(1.0 - share);
    if !(from_end > 0.0 && from_end < 10.0) {
        return percent(share);
    }
    let digits = (1.0 - libm::log10(from_end).floor()).clamp(1.0, 6.0) as usize;
    let text = format!("{:.digits$}", 100.0 * share);
    format!("{}%", text.trim_end_matches('0').trim_end_matches('.'))
}

/// `n cases`, `1 case`.
pub fn counted(n: usize, what: &str) -> String {
    format!(
        "{}{}{}",
        thousands(n),
        if what.is_empty() { "" } else { " " },
        if n == 1 { what.to_string() } else { plural(what) }
    )
}

fn plural(what: &str) -> String {
    if what.is_empty() { String::new() } else { format!("{what}s") }
}

/// A whole number with commas between its thousands.
pub fn thousands(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A power of ten, written with superscripts.
pub fn power_of_ten(decade: i32) -> String {
    let superscript = |digit: char| match digit {
        '-' => '⁻',
        _ => digit.to_digit(10).map_or(digit, |n| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][n as usize]),
    };
    format!("10{}", decade.to_string().chars().map(superscript).collect::<String>())
}

/// Letters that a terminal, a page or a drawing can show, in one line.
pub fn plain(text: &str) -> String {
    text.chars().map(|c| if c == '\n' || c == '\t' { ' ' } else { c }).filter(|c| is_shown(*c)).collect()
}

/// Whether a letter is one: no control, nothing that turns the line around.
pub fn is_shown(c: char) -> bool {
    let turns = matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    !c.is_control() && !turns
}

/// A text cut to so many letters, with a sign that it is.
pub fn cut(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_string();
    }
    text.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}

/// Lines of at most so many letters, broken at spaces where there are any.
pub fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let mut word = word.to_string();
        while word.chars().count() > most {
            let head: String = word.chars().take(most).collect();
            word = word.chars().skip(most).collect();
            lines.push(head);
        }
        let line = lines.last().map_or(0, |line| line.chars().count());
        if line > 0 && line + 1 + word.chars().count() > most {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(&word);
        }
    }
    lines.retain(|line| !line.is_empty());
    lines
}

/// Ticks of an axis: where they are, and what stands at them.
pub fn linear_ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return vec![(low, short(low))];
    }
    let raw = span / 6.0;
    let power = libm::exp10(libm::floor(libm::log10(raw)));
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|step| *step >= raw).unwrap_or(10.0 * power);
    if !step.is_normal() {
        return vec![(low, short(low))];
    }
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|i| (i as f64 * step, short(i as f64 * step))).collect()
}

/// Ticks of a logarithmic axis. Within one or two decades 1, 2 and 5 of each, else powers of ten.
pub fn log_ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    const MOST: i32 = 9;
    let (low, high) = (low.max(f64::MIN_POSITIVE), high.clamp(f64::MIN_POSITIVE, f64::MAX));
    let (from, to) = (libm::floor(libm::log10(low) + 1e-9) as i32, libm::ceil(libm::log10(high) - 1e-9) as i32);
    let inside = |x: f64| x >= low * (1.0 - 1e-9) && x <= high * (1.0 + 1e-9);
    if libm::log10(high / low) < 0.6 {
        return linear_ticks(low, high).into_iter().filter(|(x, _)| *x > 0.0).collect();
    }
    if libm::log10(high / low) < 2.3 {
        let all = (from..=to).flat_map(|d| [1.0, 2.0, 5.0].map(|m| m * libm::exp10(f64::from(d))));
        let tidy = |x: f64| shown(format!("{x:.1e}").parse().unwrap_or(x));
        return all.filter(|x| inside(*x)).map(|x| (x, tidy(x))).collect();
    }
    let every = ((to - from + MOST - 1) / MOST).max(1);
    let decades = (from..=to).filter(|d| d % every == 0).map(|d| (libm::exp10(f64::from(d)), power_of_ten(d)));
    decades.filter(|(x, _)| inside(*x)).collect()
}
