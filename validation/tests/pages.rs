//! The pages in `docs/validation/` say what the records say.

use std::fs;
use std::path::Path;
use validation::pages;

#[test]
fn every_page_shows_its_record_and_every_page_is_listed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let entries = pages::entries(&root).unwrap();
    let names = pages::names();
    for name in &names {
        let text = fs::read_to_string(root.join(pages::FOLDER).join(format!("{name}.md"))).unwrap();
        let renewed = pages::renewed(name, &text, &entries).unwrap();
        let said =
            "differs from its record; run `wakemix validate --pages` at the repository's root";
        assert!(renewed == text, "docs/validation/{name}.md {said}");
    }
    for file in fs::read_dir(root.join(pages::FOLDER)).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        let listed = name.strip_suffix(".md").is_none_or(|name| names.contains(&name));
        assert!(listed, "docs/validation/{name} belongs to no validation");
    }
}
