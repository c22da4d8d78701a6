//! The sources as what they define and what they take from each other.

use super::root;
use std::collections::HashMap;
use std::path::PathBuf;
use syn::visit::Visit;

/// One file of src/.
pub struct Source {
    /// Below src/, as messages call it.
    pub name: String,
    /// Its module path: `["collide", "faces"]`; of a `mod.rs` that of its folder.
    pub module: Vec<String>,
    pub text: String,
    pub syntax: syn::File,
}

impl Source {
    pub fn is_face(&self) -> bool {
        self.name.ends_with("mod.rs")
    }

    /// The floor's room: a folder of src/, or a file beside them.
    pub fn room(&self) -> &str {
        self.module.first().map_or("lib", String::as_str)
    }
}

/// All files of src/ but `main.rs`, which is another crate.
pub fn sources() -> Vec<Source> {
    let read = |path: PathBuf| {
        let name = path.strip_prefix(root().join("src")).unwrap().to_str().unwrap().replace('\\', "/");
        let mut module: Vec<String> = name.trim_end_matches(".rs").split('/').map(str::to_string).collect();
        if module.last().is_some_and(|last| last == "mod") || module == ["lib"] {
            module.pop();
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let syntax = syn::parse_file(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        Source { name, module, text, syntax }
    };
    super::files("src", "rs").into_iter().filter(|path| !path.ends_with("src/main.rs")).map(read).collect()
}

/// Which file takes something from which: pairs of indices, without those of a file with itself or from a face.
pub fn arrows(sources: &[Source]) -> Vec<(usize, usize)> {
    let crate_ = Crate::new(sources);
    let mut arrows = Vec::new();
    for (i, source) in sources.iter().enumerate().filter(|(_, source)| !source.is_face() && source.name != "lib.rs") {
        let mut paths = Paths { module: &source.module, found: Vec::new(), aliases: HashMap::new() };
        // A module that is declared here is a name here.
        for item in &source.syntax.items {
            if let syn::Item::Mod(child) = item {
                let path = source.module.iter().cloned().chain([child.ident.to_string()]).collect();
                paths.aliases.insert(child.ident.to_string(), path);
            }
        }
        paths.visit_file(&source.syntax);
        for path in paths.found {
            match crate_.file_of(&path) {
                Some(to) if to != i && !sources[to].module.is_empty() => arrows.push((i, to)),
                _ => {}
            }
        }
    }
    arrows.sort_unstable();
    arrows.dedup();
    arrows
}

/// Modules, and what faces hand on.
struct Crate {
    modules: HashMap<Vec<String>, usize>,
    /// A name in a module → what it is a name for.
    handed_on: HashMap<(Vec<String>, String), Vec<String>>,
}

impl Crate {
    fn new(sources: &[Source]) -> Self {
        let modules = sources.iter().enumerate().map(|(i, source)| (source.module.clone(), i)).collect();
        let mut handed_on = HashMap::new();
        for source in sources {
            for item in &source.syntax.items {
                let syn::Item::Use(item) = item else { continue };
                if matches!(item.vis, syn::Visibility::Inherited) {
                    continue;
                }
                for (name, path) in flat(&item.tree, &[]) {
                    handed_on.insert((source.module.clone(), name), absolute(&path, &source.module, true));
                }
            }
        }
        Crate { modules, handed_on }
    }

    /// The file that defines what an absolute path leads to; none: it leads out of the crate.
    fn file_of(&self, path: &[String]) -> Option<usize> {
        let len = (1..=path.len()).rev().find(|len| self.modules.contains_key(&path[..*len]))?;
        if let Some(name) = path.get(len)
            && let Some(target) = self.handed_on.get(&(path[..len].to_vec(), name.clone()))
        {
            let target: Vec<String> = target.iter().chain(&path[len + 1..]).cloned().collect();
            // A macro is handed on under its own name.
            if target != path {
                return self.file_of(&target);
            }
        }
        self.modules.get(&path[..len]).copied()
    }
}

/// Every path of a file that begins in this crate, absolute.
struct Paths<'a> {
    module: &'a [String],
    found: Vec<Vec<String>>,
    /// Names that `use` has made, and what they are names for.
    aliases: HashMap<String, Vec<String>>,
}

impl<'ast> Visit<'ast> for Paths<'_> {
    fn visit_file(&mut self, file: &'ast syn::File) {
        // Names first: a path may stand before the `use` that it begins with.
        for item in &file.items {
            if let syn::Item::Use(item) = item {
                self.visit_item_use(item);
            }
        }
        syn::visit::visit_file(self, file);
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        for (name, path) in flat(&item.tree, &[]) {
            if matches!(path[0].as_str(), "crate" | "super" | "self") {
                let path = absolute(&path, self.module, false);
                self.aliases.insert(name, path.clone());
                self.found.push(path);
            }
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.take(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        syn::visit::visit_path(self, path);
    }

    /// What stands in a macro is tokens: paths are words with `::` between them.
    fn visit_macro(&mut self, mac: &'ast syn::Macro) {
        let text = mac.tokens.to_string().replace(" :: ", "::").replace(":: ", "::").replace(" ::", "::");
        for word in text.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':')) {
            let segments: Vec<String> = word.split("::").filter(|s| !s.is_empty()).map(str::to_string).collect();
            if segments.len() > 1 {
                self.take(segments);
            }
        }
        syn::visit::visit_macro(self, mac);
    }
}

impl Paths<'_> {
    fn take(&mut self, path: Vec<String>) {
        match path[0].as_str() {
            "crate" | "super" | "self" if path.len() > 1 => self.found.push(absolute(&path, self.module, false)),
            first if path.len() > 1 => {
                if let Some(alias) = self.aliases.get(first) {
                    self.found.push(alias.iter().chain(&path[1..]).cloned().collect());
                }
            }
            _ => {}
        }
    }
}

/// The leaves of a `use`: the name that each makes, and its path.
fn flat(tree: &syn::UseTree, before: &[String]) -> Vec<(String, Vec<String>)> {
    let with = |last: &syn::Ident| before.iter().cloned().chain([last.to_string()]).collect::<Vec<_>>();
    match tree {
        syn::UseTree::Path(path) => flat(&path.tree, &with(&path.ident)),
        syn::UseTree::Group(group) => group.items.iter().flat_map(|item| flat(item, before)).collect(),
        syn::UseTree::Name(name) if name.ident == "self" => vec![(before.last().unwrap().clone(), before.to_vec())],
        syn::UseTree::Name(name) => vec![(name.ident.to_string(), with(&name.ident))],
        syn::UseTree::Rename(rename) => vec![(rename.rename.to_string(), with(&rename.ident))],
        syn::UseTree::Glob(_) => vec![("*".to_string(), before.to_vec())],
    }
}

/// From the crate's root. A face may leave out `self::`.
fn absolute(path: &[String], module: &[String], of_face: bool) -> Vec<String> {
    let ups = path.iter().take_while(|segment| *segment == "super").count();
    match path[0].as_str() {
        "crate" => path[1..].to_vec(),
        "self" => module.iter().chain(&path[1..]).cloned().collect(),
        "super" => module[..module.len() - ups].iter().chain(&path[ups..]).cloned().collect(),
        _ if of_face => module.iter().chain(path).cloned().collect(),
        _ => path.to_vec(),
    }
}

/// A way of files from one back to itself; none: nothing goes in a circle.
pub fn circle(arrows: &[(usize, usize)], files: usize) -> Option<Vec<usize>> {
    // 0: not seen, 1: on the way here, 2: done.
    fn walk(at: usize, to: &[Vec<usize>], seen: &mut [u8], way: &mut Vec<usize>) -> Option<Vec<usize>> {
        seen[at] = 1;
        way.push(at);
        for &next in &to[at] {
            if seen[next] == 1 {
                let from = way.iter().position(|file| *file == next).unwrap();
                return Some(way[from..].iter().copied().chain([next]).collect());
            }
            if seen[next] == 0
                && let Some(found) = walk(next, to, seen, way)
            {
                return Some(found);
            }
        }
        seen[at] = 2;
        way.pop();
        None
    }
    let mut to = vec![Vec::new(); files];
    arrows.iter().for_each(|(a, b)| to[*a].push(*b));
    let mut seen = vec![0; files];
    (0..files).find_map(|file| if seen[file] == 0 { walk(file, &to, &mut seen, &mut Vec::new()) } else { None })
}
