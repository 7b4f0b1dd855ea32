//! Tags in the text of XML files, as far as the heads of image data need them.

/// The first tag called `name` of which `is_one` holds, without its brackets.
pub(super) fn tag<'a>(text: &'a str, name: &str, is_one: impl Fn(&str) -> bool) -> Option<&'a str> {
    let mut rest = text;
    while let Some(place) = rest.find('<') {
        rest = &rest[place + 1..];
        let end = rest.find('>')?;
        let own = &rest[..end];
        let word = own.split(|c: char| c.is_whitespace() || c == '/').next();
        if word == Some(name) && is_one(own) {
            return Some(own);
        }
        rest = &rest[end..];
    }
    None
}

/// What stands between `tag`, a part of `text`, and the next one.
pub(super) fn content<'a>(text: &'a str, tag: &str) -> Option<&'a str> {
    let from = tag.as_ptr() as usize - text.as_ptr() as usize + tag.len() + 1;
    let rest = text.get(from..)?;
    Some(&rest[..rest.find('<')?])
}

/// The attribute called `name` of `tag`.
pub(super) fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let mut rest = tag;
    while let Some(place) = rest.find(name) {
        let before = rest[..place].chars().next_back();
        let after = &rest[place + name.len()..];
        if before.is_some_and(char::is_whitespace)
            && let Some(value) = after.trim_start().strip_prefix('=')
        {
            let value = value.trim_start();
            let quote = value.chars().next().filter(|c| ['"', '\''].contains(c))?;
            let value = &value[1..];
            return Some(&value[..value.find(quote)?]);
        }
        rest = after;
    }
    None
}

/// The numbers of the attribute `name` of `tag`.
pub(super) fn numbers<T: std::str::FromStr, const N: usize>(
    tag: &str,
    name: &str,
) -> Result<[T; N], String> {
    let text = attribute(tag, name).ok_or_else(|| format!("it lacks `{name}`"))?;
    let values: Option<Vec<T>> =
        text.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
    let values = values.and_then(|values| values.try_into().ok());
    values.ok_or_else(|| format!("`{name}` does not hold {N} numbers"))
}
