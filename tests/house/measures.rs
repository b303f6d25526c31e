//! How much the source repeats itself, as figures: `scripts/measure` prints them.

use crate::{root, sources};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::Path;
use syn::visit::{self, Visit};

/// What is counted, over the sources of `crates/*/src` without their tests.
#[derive(Debug, Default)]
pub(crate) struct Measures {
    /// The files in which each type is defined.
    types: BTreeMap<String, BTreeSet<String>>,
    /// The files in which each type of a crate has inherent methods.
    methods: BTreeMap<String, BTreeSet<String>>,
    /// Functions with a tuple among their parameters.
    tuples: Vec<String>,
    /// Files that decide by what a run is judged.
    judging: BTreeSet<String>,
    /// Lines of the program in files that run or judge a scene themselves.
    program: usize,
    /// Lines of code, without comments, blank lines and unit tests.
    lines: usize,
}

impl Measures {
    /// Reads every source file.
    pub(crate) fn of_the_project() -> Self {
        let crates = root().join("crates");
        let mut measures = Self::default();
        for (path, text) in sources(&["rs"]) {
            let Ok(inside) = path.strip_prefix(&crates) else { continue };
            let Some(member) = inside.iter().next().map(|name| name.to_string_lossy().into_owned()) else {
                continue;
            };
            if inside.iter().nth(1).is_none_or(|folder| folder != "src") {
                continue;
            }
            measures.read(&member, inside, &text);
        }
        measures
    }

    fn read(&mut self, member: &str, path: &Path, text: &str) {
        let shown = path.display().to_string();
        let file = syn::parse_file(text).unwrap_or_else(|error| panic!("{shown}: {error}"));
        let lines = lines_of_code(path, text);
        self.lines += lines;
        let mut reader = Reader { measures: self, member, shown: &shown, uses: BTreeSet::new() };
        reader.visit_file(&file);
        let runs = ["simulation", "formation", "world", "perception"];
        if member == "cli" && reader.uses.iter().any(|name| runs.contains(&name.as_str())) {
            self.program += lines;
        }
    }

    /// Types that are defined in more than one file.
    pub(crate) fn shared_types(&self) -> impl Iterator<Item = (&String, &BTreeSet<String>)> {
        self.types.iter().filter(|(_, files)| files.len() > 1)
    }

    /// Their share of all types.
    pub(crate) fn shared_share(&self) -> f64 {
        self.shared_types().count() as f64 / self.types.len() as f64
    }

    /// Types whose methods stand in more than one file, but for those that have a module folder to themselves.
    pub(crate) fn scattered(&self) -> impl Iterator<Item = (&String, &BTreeSet<String>)> {
        self.methods.iter().filter(|(_, files)| files.len() > 1 && !in_a_module(files))
    }

    /// Functions with tuples among their parameters.
    pub(crate) fn tuple_functions(&self) -> &[String] {
        &self.tuples
    }

    /// Files that decide from when on, and within which band, errors are judged.
    pub(crate) fn judging_places(&self) -> &BTreeSet<String> {
        &self.judging
    }

    /// Lines of the program that run or judge scenes.
    pub(crate) fn program_lines(&self) -> usize {
        self.program
    }
}

impl fmt::Display for Measures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shared = self.shared_types().count();
        let readme = std::fs::read_to_string(root().join("README.md")).map_err(|_| fmt::Error)?;
        writeln!(
            f,
            "type names defined in two or more files   {shared} of {}, {:.1} %",
            self.types.len(),
            100.0 * self.shared_share()
        )?;
        writeln!(f, "functions with tuple parameters           {}", self.tuples.len())?;
        writeln!(f, "lines of `cli` that run or judge scenes    {}", self.program)?;
        writeln!(f, "files that decide what is judged           {}", self.judging.len())?;
        writeln!(f, "types with scattered methods              {}", self.scattered().count())?;
        writeln!(f, "lines of the README                       {}", readme.lines().count())?;
        writeln!(f, "production lines of code                  {}", self.lines)
    }
}

/// Lines of a file that are neither blank nor a comment, up to the module of its unit tests.
fn lines_of_code(path: &Path, text: &str) -> usize {
    if path.ends_with("tests.rs") {
        return 0;
    }
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text);
    code.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

/// Walks one file.
struct Reader<'a> {
    measures: &'a mut Measures,
    member: &'a str,
    shown: &'a str,
    /// First segments of its paths.
    uses: BTreeSet<String>,
}

impl Reader<'_> {
    fn defines(&mut self, name: &syn::Ident) {
        self.measures.types.entry(name.to_string()).or_default().insert(self.shown.to_owned());
    }

    fn takes(&mut self, signature: &syn::Signature) {
        let is_tuple =
            |argument: &syn::FnArg| matches!(argument, syn::FnArg::Typed(typed) if tuple(&typed.ty));
        if signature.inputs.iter().any(is_tuple) {
            self.measures.tuples.push(format!("{} in {}", signature.ident, self.shown));
        }
    }
}

/// Whether all files lie in one folder below `src`, which is a module.
fn in_a_module(files: &BTreeSet<String>) -> bool {
    let folders: BTreeSet<_> = files.iter().filter_map(|file| Path::new(file).parent()).collect();
    folders.len() == 1 && folders.iter().all(|folder| folder.file_name().is_some_and(|name| name != "src"))
}

/// Whether a type is a tuple of values or a reference to one; `()` is none.
fn tuple(of: &syn::Type) -> bool {
    match of {
        syn::Type::Tuple(tuple) => !tuple.elems.is_empty(),
        syn::Type::Reference(reference) => tuple(&reference.elem),
        _ => false,
    }
}

fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|a| {
        a.path().is_ident("cfg")
            && matches!(&a.meta, syn::Meta::List(list) if list.tokens.to_string() == "test")
    })
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !is_test(&item.attrs) {
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_struct(&mut self, item: &'ast syn::ItemStruct) {
        self.defines(&item.ident);
        visit::visit_item_struct(self, item);
    }

    fn visit_item_enum(&mut self, item: &'ast syn::ItemEnum) {
        self.defines(&item.ident);
        visit::visit_item_enum(self, item);
    }

    fn visit_item_trait(&mut self, item: &'ast syn::ItemTrait) {
        self.defines(&item.ident);
        visit::visit_item_trait(self, item);
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        if let (None, syn::Type::Path(path)) = (&item.trait_, &*item.self_ty)
            && let Some(last) = path.path.segments.last()
        {
            let name = format!("{}::{}", self.member, last.ident);
            self.measures.methods.entry(name).or_default().insert(self.shown.to_owned());
        }
        visit::visit_item_impl(self, item);
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.takes(&item.sig);
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.takes(&item.sig);
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        self.takes(&item.sig);
        visit::visit_trait_item_fn(self, item);
    }

    fn visit_expr_struct(&mut self, item: &'ast syn::ExprStruct) {
        if item.path.segments.last().is_some_and(|last| last.ident == "Judging") {
            self.measures.judging.insert(self.shown.to_owned());
        }
        visit::visit_expr_struct(self, item);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        if let Some(first) = path.segments.first().filter(|_| path.segments.len() > 1) {
            self.uses.insert(first.ident.to_string());
        }
        visit::visit_path(self, path);
    }

    fn visit_use_path(&mut self, item: &'ast syn::UsePath) {
        self.uses.insert(item.ident.to_string());
        visit::visit_use_path(self, item);
    }
}

#[test]
fn measures_are_read_from_syntax() {
    let mut measures = Measures::default();
    let text = "struct A; impl A { fn f(&self, at: (f64, f64)) {} fn g(&self, x: [f64; 2]) {} }\n\
                fn h(a: &(u8, u8)) -> f64 { Judging { settled_after: 0.0 }.settled_after }\n\
                #[cfg(test)]\nmod tests { struct B; fn k(a: (u8, u8)) {} }\n";
    measures.read("cli", Path::new("cli/src/a.rs"), text);
    measures.read("cli", Path::new("cli/src/b.rs"), "use simulation::Simulation;\nenum A {}\nimpl A {}\n");
    assert_eq!(measures.shared_types().count(), 1);
    assert_eq!(measures.types.len(), 1, "{:?}", measures.types);
    assert_eq!(measures.tuple_functions(), ["f in cli/src/a.rs", "h in cli/src/a.rs"]);
    assert_eq!(measures.scattered().count(), 1);
    assert_eq!(measures.judging_places().len(), 1);
    assert_eq!((measures.program_lines(), measures.lines), (3, 5));
}

/// `scripts/measure` shows what this prints.
#[test]
fn the_source_does_not_repeat_itself() {
    let measures = Measures::of_the_project();
    println!("{measures}");
    assert_eq!(measures.program_lines(), 0, "what runs or judges scenes belongs to `studies`");
    assert!(measures.shared_share() <= 0.03, "{:?}", measures.shared_types().collect::<Vec<_>>());
    assert!(measures.tuple_functions().is_empty(), "{:?}", measures.tuple_functions());
    assert_eq!(
        measures.scattered().next(),
        None,
        "methods of one type stand in one file, or in a module of it"
    );
    assert_eq!(measures.judging_places().iter().collect::<Vec<_>>(), ["scene/src/types/expect.rs"]);
    if std::env::var_os("MEASURE_ALL").is_some() {
        for (name, files) in measures.shared_types() {
            println!("type {name}: {files:?}");
        }
        for (name, files) in measures.scattered() {
            println!("methods of {name}: {files:?}");
        }
        for name in measures.tuple_functions() {
            println!("tuple: {name}");
        }
        println!("judging: {:?}", measures.judging_places());
    }
}
