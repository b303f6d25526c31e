//! A law that is a WebAssembly module.

use super::declared::{MISTAKES_MAX, declared, shown};
use super::host::{FROM, Host, OFFERED, offered};
use crate::custom_law::{CustomLaw, Fault};
use crate::declaration::{Declaration, Quantity};
use crate::input::{INPUTS, Input};
use crate::language::did_you_mean;
use crate::noise::Noise;
use std::fmt;
use vocabulary::Command;
use wasmi::errors::{ErrorKind, InstantiationError};
use wasmi::{
    CompilationMode, Config, EnforcedLimits, Engine, Error, ExternType, FuncType, Instance, Linker, Memory,
    Module, Store, StoreLimitsBuilder, TrapCode, ValType, WasmParams,
};

/// Largest module, bytes.
const MODULE_MAX: usize = 1_000_000;
/// Largest linear memory, bytes.
const MEMORY_MAX: usize = 16 << 20;
/// Most tables.
const TABLES_MAX: usize = 4;
/// Largest table, entries.
const TABLE_MAX: usize = 10_000;
/// Longest declaration, bytes.
const TEXT_MAX: usize = 64_000;
/// Numbers for which a module has room in its region.
const REGION: usize = 1024;
/// Instructions that a call may execute. A bound on time only: it is never recorded, for versions of wasmi count differently.
const FUEL: u64 = 5_000_000;
/// Most calls within calls, and the bytes of their values.
const STACK_MAX: [usize; 2] = [1000, 1 << 20];

/// What a law exports besides its memory, with the numbers of its arguments and results, and whether it has to. All are `i32`.
const EXPORTS: [(&str, [usize; 2], bool); 5] = [
    ("declaration", [0, 1], true),
    ("region", [0, 1], true),
    ("start", [3, 0], false),
    ("decide", [5, 0], true),
    ("derive", [5, 0], false),
];

/// A law that is a WebAssembly module.
///
/// Every call gets an instance of its own: what a module keeps in its globals and its linear memory cannot outlive a call, so a
/// run can be saved, rewound and branched at any sample. What lasts is the memory that it declares.
pub struct WasmLaw {
    declaration: Declaration,
    module: Module,
    linker: Linker<Host>,
    /// Address of the region through which numbers go in and out, in bytes.
    region: u32,
    has_start: bool,
}

impl fmt::Debug for WasmLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("WasmLaw").field("declaration", &self.declaration).finish_non_exhaustive()
    }
}

impl WasmLaw {
    /// Reads a module, checks what it exports and imports, and asks for its declaration.
    ///
    /// # Errors
    /// What is wrong with it, one message each, at most 20.
    pub fn new(bytes: &[u8]) -> Result<Self, Vec<String>> {
        if bytes.len() > MODULE_MAX {
            let most = MODULE_MAX / 1_000_000;
            return Err(vec![format!("it has {} bytes: {most} MB is the most for a module", bytes.len())]);
        }
        let one = |error: Error| vec![told(&error)];
        let engine = Engine::new(&config());
        // First all of it: where code stands behind the end of a function, translation would panic before validation.
        let module = Module::validate(&engine, bytes).and_then(|()| Module::new(&engine, bytes));
        let module = module
            .map_err(|error| vec![format!("it is not a module that can run here: {}", told(&error))])?;
        let linker = offered(&engine).map_err(one)?;
        let mut mistakes = exports_missing(&module);
        mistakes.extend(imports_refused(&module));
        if !mistakes.is_empty() {
            mistakes.truncate(MISTAKES_MAX);
            return Err(mistakes);
        }
        let exports = |name: &str| module.get_export(name).is_some();
        let (has_start, continuous) = (exports("start"), exports("derive"));
        let mut law = Self { declaration: Declaration::default(), module, linker, region: 0, has_start };
        law.region = law.region_asked()?;
        law.declaration = declared(&law.text_asked()?, continuous)?;
        let Declaration { memory, shown, .. } = &law.declaration;
        let rates = if continuous { memory.len() } else { 0 };
        let needed = law.layout(shown.len().max(rates)).end;
        if needed > REGION {
            let text = format!(
                "its declaration: it names too much: a call would take {needed} numbers, and there is \
                                room for {REGION}"
            );
            return Err(vec![text]);
        }
        Ok(law)
    }

    /// The text at the address that `declaration` returns.
    fn text_asked(&self) -> Result<String, Vec<String>> {
        let (mut instance, address) = self.asked("declaration")?;
        let memory = instance.memory().map_err(|error| vec![told(&error)])?;
        let data = memory.data(&mut instance.store);
        let text = data.get(address as usize..).unwrap_or(&[]);
        let text = &text[..text.len().min(TEXT_MAX + 1)];
        let Some(end) = text.iter().position(|byte| *byte == 0) else {
            let why = format!(
                "`declaration` returns {address}: there is no text of at most {TEXT_MAX} bytes that ends with a \
                               zero"
            );
            return Err(vec![why]);
        };
        let text = std::str::from_utf8(&text[..end]);
        text.map(str::to_owned).map_err(|_| vec!["its declaration is not UTF-8 text".to_owned()])
    }

    /// The address that `region` returns.
    fn region_asked(&self) -> Result<u32, Vec<String>> {
        let (_, address) = self.asked("region")?;
        let minimum = self.module.get_export("memory").and_then(|own| own.memory().map(|own| own.minimum()));
        let room = minimum.unwrap_or(0).saturating_mul(1 << 16);
        let fits = address.is_multiple_of(8) && u64::from(address) + 8 * REGION as u64 <= room;
        if fits {
            return Ok(address);
        }
        let why = format!(
            "`region` returns {address}: it must be a multiple of 8 with room for {REGION} numbers behind it in the \
             {room} bytes with which its memory begins"
        );
        Err(vec![why])
    }

    /// What an exported function without arguments returns.
    fn asked(&self, name: &str) -> Result<(Running, u32), Vec<String>> {
        let failed = |error: Error| vec![format!("`{name}` failed: {}", told(&error))];
        let mut running = self.instantiated(Noise::default()).map_err(|error| vec![told(&error)])?;
        let function = running.instance.get_typed_func::<(), u32>(&running.store, name).map_err(failed)?;
        let address = function.call(&mut running.store, ()).map_err(failed)?;
        Ok((running, address))
    }

    /// A fresh instance with its fuel.
    fn instantiated(&self, noise: Noise) -> Result<Running, Error> {
        let limits = StoreLimitsBuilder::new()
            .memory_size(MEMORY_MAX)
            .table_elements(TABLE_MAX)
            .tables(TABLES_MAX)
            .memories(1)
            .instances(1)
            .trap_on_grow_failure(true)
            .build();
        let mut store = Store::new(self.linker.engine(), Host { limits, noise });
        store.limiter(|host| &mut host.limits);
        store.set_fuel(FUEL)?;
        let instance = self.linker.instantiate_and_start(&mut store, &self.module)?;
        Ok(Running { store, instance })
    }

    /// Where the parts of the region begin, with `out` numbers shown or derived.
    fn layout(&self, out: usize) -> RegionLayout {
        let Declaration { leaders, parameters, memory, .. } = &self.declaration;
        let per_leader = INPUTS.iter().filter(|(kind, ..)| kind.is_per_leader()).count();
        let parameters_at = INPUTS.len() - per_leader + leaders * per_leader;
        let memory_at = parameters_at + parameters.len();
        let out_at = memory_at + memory.len();
        let command = out_at + out;
        RegionLayout { parameters: parameters_at, memory: memory_at, out: out_at, command, end: command + 2 }
    }

    /// Calls an exported function of so many arguments over the region, and returns the numbers there.
    fn call<P: WasmParams>(
        &self,
        name: &str,
        arguments: impl Fn([u32; 5]) -> P,
        input: &Input<'_>,
        [parameters, memory]: [&[f64]; 2],
        layout: &RegionLayout,
    ) -> Result<Vec<f64>, Fault> {
        let called = || -> Result<Vec<f64>, Error> {
            let mut running = self.instantiated(input.noise)?;
            let mut bytes = Vec::with_capacity(8 * layout.end);
            let mut put = |number: f64| bytes.extend_from_slice(&number.to_le_bytes());
            let told = |own: bool| INPUTS.iter().filter(move |(kind, ..)| kind.is_per_leader() != own);
            told(true).for_each(|(kind, ..)| put(input.value(0, *kind)));
            for leader in 0..self.declaration.leaders {
                told(false).for_each(|(kind, ..)| put(input.value(leader, *kind)));
            }
            parameters.iter().chain(memory).for_each(|number| put(*number));
            // What is to be written begins as no number, so that what is forgotten is a fault.
            (layout.out..layout.end).for_each(|_| put(f64::NAN));
            let own = running.memory()?;
            let region = self.region as usize..self.region as usize + bytes.len();
            // The memory of an instance begins with room for the region, and does not shrink.
            let outside = || Error::from(TrapCode::MemoryOutOfBounds);
            own.data_mut(&mut running.store)
                .get_mut(region.clone())
                .ok_or_else(outside)?
                .copy_from_slice(&bytes);
            let at = |number: usize| self.region + 8 * number as u32;
            let addresses = [0, layout.parameters, layout.memory, layout.out, layout.command].map(at);
            let function = running.instance.get_typed_func::<P, ()>(&running.store, name)?;
            function.call(&mut running.store, arguments(addresses))?;
            let bytes = own.data(&running.store).get(region).ok_or_else(outside)?;
            let (numbers, _) = bytes.as_chunks::<8>();
            Ok(numbers.iter().map(|number| f64::from_le_bytes(*number)).collect())
        };
        called().map_err(|error| fault(told(&error)))
    }

    /// The command of `decide` or `derive`, with what these wrote into `out`.
    fn command(
        &self,
        name: &str,
        input: &Input<'_>,
        numbers: [&[f64]; 2],
        out: &mut [f64],
    ) -> Result<(Command, Vec<f64>), Fault> {
        let layout = self.layout(out.len());
        let all = self.call(name, |[a, b, c, d, e]| (a, b, c, d, e), input, numbers, &layout)?;
        out.copy_from_slice(&all[layout.out..layout.command]);
        let command = Command { acceleration: all[layout.command], turn_rate: all[layout.command + 1] };
        finite("the acceleration", command.acceleration)?;
        finite("the turn rate", command.turn_rate)?;
        Ok((command, all[layout.memory..layout.out].to_vec()))
    }
}

/// An instance of a module, with what belongs to it.
struct Running {
    store: Store<Host>,
    instance: Instance,
}

impl Running {
    fn memory(&self) -> Result<Memory, Error> {
        let memory = self.instance.get_memory(&self.store, "memory");
        memory.ok_or_else(|| Error::new("it exports no `memory`"))
    }
}

/// Where the parts of a region begin, in numbers.
struct RegionLayout {
    parameters: usize,
    memory: usize,
    out: usize,
    command: usize,
    end: usize,
}

impl CustomLaw for WasmLaw {
    fn declaration(&self) -> &Declaration {
        &self.declaration
    }

    fn start(&self, input: &Input<'_>, parameters: &[f64], memory: &mut [f64]) -> Result<(), Fault> {
        memory.fill(0.0);
        if self.has_start {
            let layout = self.layout(0);
            let all = self.call("start", |[a, b, c, ..]| (a, b, c), input, [parameters, memory], &layout)?;
            memory.copy_from_slice(&all[layout.memory..layout.out]);
        }
        all_finite("the memory", &self.declaration.memory, memory)
    }

    fn decide(
        &self,
        input: &Input<'_>,
        parameters: &[f64],
        memory: &mut [f64],
        shown: &mut [f64],
    ) -> Result<Command, Fault> {
        let (command, next) = self.command("decide", input, [parameters, memory], shown)?;
        memory.copy_from_slice(&next);
        all_finite("the memory", &self.declaration.memory, memory)?;
        all_finite("the shown", &self.declaration.shown, shown)?;
        Ok(command)
    }

    fn derive(
        &self,
        input: &Input<'_>,
        parameters: &[f64],
        memory: &[f64],
        rates: &mut [f64],
    ) -> Result<Command, Fault> {
        let (command, _) = self.command("derive", input, [parameters, memory], rates)?;
        all_finite("the derivative of", &self.declaration.memory, rates)?;
        Ok(command)
    }
}

/// WebAssembly without what is not needed or not the same everywhere, each call bounded.
fn config() -> Config {
    let mut config = Config::default();
    let [depth, height] = STACK_MAX;
    config
        .consume_fuel(true)
        // What is compiled at the first call would take fuel from it.
        .compilation_mode(CompilationMode::Eager)
        .ignore_custom_sections(true)
        .enforced_limits(EnforcedLimits::strict())
        .wasm_multi_memory(false)
        .set_max_recursion_depth(depth)
        .set_max_stack_height(height);
    config
}

/// What a module ought to export and does not.
fn exports_missing(module: &Module) -> Vec<String> {
    let mut mistakes = vec![];
    match module.get_export("memory") {
        Some(ExternType::Memory(_)) => {}
        Some(_) => mistakes.push("it exports `memory`, which is not its memory".to_owned()),
        None => mistakes.push("it exports no `memory`".to_owned()),
    }
    for (name, [arguments, results], needed) in EXPORTS {
        let wanted = FuncType::new(vec![ValType::I32; arguments], vec![ValType::I32; results]);
        match module.get_export(name) {
            Some(ExternType::Func(own)) if own == wanted => {}
            None if !needed => {}
            None => mistakes.push(format!("it exports no function `{name}`, {}", signature(&wanted))),
            Some(ExternType::Func(own)) => {
                let [wanted, own] = [signature(&wanted), signature(&own)];
                mistakes.push(format!("it exports `{name}` as {own}: a law has {wanted}"));
            }
            Some(_) => {
                mistakes.push(format!("it exports `{name}`, which is not a function {}", signature(&wanted)));
            }
        }
    }
    mistakes
}

/// What a module imports and may not.
fn imports_refused(module: &Module) -> Vec<String> {
    let names = || OFFERED.into_iter().map(|(name, _)| name);
    let mut mistakes = vec![];
    for import in module.imports() {
        let (from, own) = (import.module(), import.name());
        let name = format!("`{}.{}`", shown(from), shown(own));
        let Some((_, offer)) = OFFERED.into_iter().find(|(known, _)| from == FROM && *known == own) else {
            let hint = if from == FROM { did_you_mean(own, names()) } else { String::new() };
            let offer = names().collect::<Vec<_>>().join(", ");
            mistakes.push(format!("it imports {name}{hint}; a law computes alone: `{FROM}` has {offer}"));
            continue;
        };
        let given = FuncType::new(offer.arguments().iter().copied(), [ValType::F64]);
        match import.ty() {
            ExternType::Func(wanted) if *wanted == given => {}
            ExternType::Func(wanted) => {
                let [wanted, given] = [signature(wanted), signature(&given)];
                mistakes.push(format!("it imports {name} as {wanted}, which is {given}"));
            }
            _ => mistakes.push(format!("it imports {name}, which is a function")),
        }
        if own == "noise" && module.get_export("derive").is_some() {
            let text = "it exports `derive` and imports `env.noise`: there is no noise in continuous time";
            mistakes.push(text.to_owned());
        }
    }
    mistakes
}

/// The type of a function, such as "(f64, f64) -> f64".
fn signature(own: &FuncType) -> String {
    let list = |types: &[ValType]| types.iter().copied().map(named).collect::<Vec<_>>().join(", ");
    match own.results() {
        [] => format!("({})", list(own.params())),
        [one] => format!("({}) -> {}", list(own.params()), named(*one)),
        several => format!("({}) -> ({})", list(own.params()), list(several)),
    }
}

fn named(own: ValType) -> &'static str {
    match own {
        ValType::I32 => "i32",
        ValType::I64 => "i64",
        ValType::F32 => "f32",
        ValType::F64 => "f64",
        ValType::V128 => "v128",
        ValType::FuncRef => "funcref",
        ValType::ExternRef => "externref",
    }
}

fn fault(message: String) -> Fault {
    Fault { place: None, message }
}

fn finite(what: &str, number: f64) -> Result<(), Fault> {
    if number.is_finite() {
        return Ok(());
    }
    let is = if number.is_nan() { "not a number" } else { "infinite" };
    Err(fault(format!("{what} is {is}")))
}

fn all_finite(what: &str, names: &[Quantity], numbers: &[f64]) -> Result<(), Fault> {
    names.iter().zip(numbers).try_for_each(|(own, number)| finite(&format!("{what} `{}`", own.name), *number))
}

/// What went wrong, in the words of somebody who wrote a law.
fn told(error: &Error) -> String {
    let memory = || format!("out of memory: it asked for more than {} MiB", MEMORY_MAX >> 20);
    let table = || format!("it asked for a table of more than {TABLE_MAX} entries");
    let Some(code) = error.as_trap_code() else {
        return match error.kind() {
            ErrorKind::Memory(_)
            | ErrorKind::Instantiation(InstantiationError::FailedToInstantiateMemory(_)) => memory(),
            ErrorKind::Table(_)
            | ErrorKind::Instantiation(InstantiationError::FailedToInstantiateTable(_)) => table(),
            other => shown_whole(&other.to_string()),
        };
    };
    match code {
        TrapCode::OutOfFuel => format!("out of fuel: it ran for more than {FUEL} instructions"),
        TrapCode::UnreachableCodeReached => {
            "it broke off: `unreachable` was executed, as at a panic or an abort".to_owned()
        }
        TrapCode::MemoryOutOfBounds => "it reached outside of its memory".to_owned(),
        TrapCode::TableOutOfBounds | TrapCode::IndirectCallToNull | TrapCode::BadSignature => {
            "it called a function through a pointer that leads to none".to_owned()
        }
        TrapCode::IntegerDivisionByZero => "it divided a whole number by zero".to_owned(),
        TrapCode::IntegerOverflow => "the quotient of two whole numbers was too large".to_owned(),
        TrapCode::BadConversionToInteger => {
            "it turned a number into a whole number that is too large, or no number".to_owned()
        }
        TrapCode::StackOverflow => "its stack is full: it called itself too often".to_owned(),
        TrapCode::GrowthOperationLimited => format!("{}, or {}", memory(), table()),
        TrapCode::OutOfSystemMemory => "out of memory: the machine has no more".to_owned(),
    }
}

/// The words of the library in one line, not too long.
fn shown_whole(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(300).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::module::host::PRICE;

    #[test]
    fn the_page_on_modules_states_the_bounds() {
        let page = include_str!("../../../../docs/law-modules.md");
        let thousands = |n: u64| {
            let digits = n.to_string();
            let groups: Vec<&str> =
                digits.as_bytes().rchunks(3).rev().map(|g| std::str::from_utf8(g).unwrap()).collect();
            groups.join(" ")
        };
        let entries = thousands(TABLE_MAX as u64);
        for row in [
            format!("| module | {} MB |", MODULE_MAX / 1_000_000),
            format!(
                "| instructions of a call | {}, counted by the interpreter; an imported function counts for {PRICE} |",
                thousands(FUEL)
            ),
            format!("| linear memory | {} MiB |", MEMORY_MAX >> 20),
            format!("| tables | {TABLES_MAX}, of {entries} entries each |"),
            format!("| calls within calls | {} |", STACK_MAX[0]),
            format!("| declaration | {} bytes |", thousands(TEXT_MAX as u64)),
            format!("room for {REGION} numbers"),
        ] {
            assert!(page.contains(&row), "docs/law-modules.md lacks: {row}");
        }
    }
}
