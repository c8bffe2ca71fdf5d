//! Tables of TOML and their fields, with the place of each.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Found, SceneProblemKind};
use crate::report::quote;

/// So many numbers of a list are shown in a message.
const SHORT_LIST: usize = 6;

/// What is wrong so far.
#[derive(Default)]
pub(crate) struct Problems {
    pub(super) list: Vec<Found>,
    /// What is odd, though it can be read.
    pub(super) warnings: Vec<Found>,
}

impl Problems {
    pub(crate) fn at(&mut self, node: &Node<'_>, kind: SceneProblemKind, message: String) {
        self.push(kind, node.span.clone(), node.path.clone(), message);
    }

    /// Says what is odd about a value that can be read.
    pub(crate) fn warn(&mut self, node: &Node<'_>, kind: SceneProblemKind, message: String) {
        self.warnings.push(Found {
            kind,
            span: node.span.clone(),
            path: node.path.clone(),
            message,
        });
    }

    /// Says that a value is not what its field holds.
    pub(crate) fn expected(&mut self, node: &Node<'_>, what: &str) {
        let message = format!("expected {what}, found {}", node.shown());
        self.at(node, SceneProblemKind::WrongValue, message);
    }

    fn push(&mut self, kind: SceneProblemKind, span: Range<usize>, path: String, message: String) {
        self.list.push(Found {
            kind,
            span,
            path,
            message,
        });
    }
}

/// A value, where it stands in the text and in the document.
#[derive(Clone)]
pub(crate) struct Node<'a> {
    value: &'a DeValue<'a>,
    span: Range<usize>,
    path: String,
}

impl<'a> Node<'a> {
    fn new(value: &'a Spanned<DeValue<'a>>, path: String) -> Self {
        Self {
            value: value.get_ref(),
            span: value.span(),
            path,
        }
    }

    pub(crate) fn text(&self) -> Option<&'a str> {
        match self.value {
            DeValue::String(text) => Some(text),
            _ => None,
        }
    }

    pub(crate) fn whole_number(&self) -> Option<i64> {
        match self.value {
            DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix()).ok(),
            _ => None,
        }
    }

    /// A number that is finite.
    #[allow(
        clippy::cast_precision_loss,
        reason = "a hexadecimal number over 2^53 is not exact, and no field needs one"
    )]
    pub(crate) fn number(&self) -> Option<f64> {
        let number = match self.value {
            DeValue::Float(number) => number.as_str().parse().ok()?,
            DeValue::Integer(number) if number.radix() == 10 => number.as_str().parse().ok()?,
            DeValue::Integer(_) => self.whole_number()? as f64,
            _ => return None,
        };
        Some(number).filter(|number: &f64| number.is_finite())
    }

    pub(crate) fn truth(&self) -> Option<bool> {
        match self.value {
            DeValue::Boolean(truth) => Some(*truth),
            _ => None,
        }
    }

    /// The numbers of an array of exactly so many.
    pub(crate) fn numbers<const N: usize>(&self) -> Option<[f64; N]> {
        let items = self.items()?;
        if items.len() != N {
            return None;
        }
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(items) {
            *number = item.number()?;
        }
        Some(numbers)
    }

    pub(crate) fn items(&self) -> Option<Vec<Self>> {
        let DeValue::Array(items) = self.value else {
            return None;
        };
        let nodes = items.iter().enumerate();
        let nodes = nodes.map(|(index, item)| Node::new(item, format!("{}[{index}]", self.path)));
        Some(nodes.collect())
    }

    pub(crate) fn fields(&self) -> Option<Fields<'a>> {
        match self.value {
            DeValue::Table(table) => Some(Fields::new(table, self.span.clone(), self.path.clone())),
            _ => None,
        }
    }

    /// A list of a few numbers, as it would be written.
    fn short_list(&self) -> Option<String> {
        let items = self.items().filter(|items| items.len() <= SHORT_LIST)?;
        let numbers: Option<Vec<&str>> = items
            .iter()
            .map(|item| match item.value {
                DeValue::Integer(number) if number.radix() == 10 => Some(number.as_str()),
                DeValue::Float(number) => Some(number.as_str()),
                _ => None,
            })
            .collect();
        Some(format!("[{}]", numbers?.join(", ")))
    }

    /// The value as a message shows it.
    pub(crate) fn shown(&self) -> String {
        match self.value {
            DeValue::String(text) => quote(format!("\"{text}\"").as_bytes()),
            DeValue::Integer(number) => quote(number.to_string().as_bytes()),
            DeValue::Float(number) => quote(number.as_str().as_bytes()),
            DeValue::Boolean(truth) => truth.to_string(),
            DeValue::Datetime(_) => "a date".to_owned(),
            DeValue::Array(items) => match self.short_list() {
                Some(list) => quote(list.as_bytes()),
                None => format!("a list of {}", items.len()),
            },
            DeValue::Table(_) => "a table".to_owned(),
        }
    }
}

/// A table whose fields are taken one by one.
pub(crate) struct Fields<'a> {
    table: &'a DeTable<'a>,
    span: Range<usize>,
    path: String,
    known: Vec<&'static str>,
}

impl<'a> Fields<'a> {
    pub(crate) fn new(table: &'a DeTable<'a>, span: Range<usize>, path: String) -> Self {
        Self {
            table,
            span,
            path,
            known: Vec::new(),
        }
    }

    /// A field, if it is there.
    pub(crate) fn optional(&mut self, name: &'static str) -> Option<Node<'a>> {
        self.known.push(name);
        let value = self.table.get(name)?;
        let path = if self.path.is_empty() {
            name.to_owned()
        } else {
            format!("{}.{name}", self.path)
        };
        Some(Node::new(value, path))
    }

    /// A field, if it is there, for a second look.
    pub(crate) fn again(&self, name: &str) -> Option<Node<'a>> {
        let value = self.table.get(name)?;
        Some(Node::new(value, format!("{}.{name}", self.path)))
    }

    /// A field that must be there.
    pub(crate) fn required(
        &mut self,
        name: &'static str,
        problems: &mut Problems,
    ) -> Option<Node<'a>> {
        let found = self.optional(name);
        if found.is_none() {
            self.problem(
                problems,
                SceneProblemKind::Missing,
                format!("expected a field `{name}`"),
            );
        }
        found
    }

    /// What a required field holds, or a problem.
    pub(crate) fn take<T>(
        &mut self,
        name: &'static str,
        what: &str,
        problems: &mut Problems,
        read: impl FnOnce(&Node<'a>) -> Option<T>,
    ) -> Option<T> {
        let node = self.required(name, problems)?;
        let value = read(&node);
        if value.is_none() {
            problems.expected(&node, what);
        }
        value
    }

    /// What an optional field holds, its default, or a problem and its default.
    pub(crate) fn take_or<T>(
        &mut self,
        name: &'static str,
        default: T,
        what: &str,
        problems: &mut Problems,
        read: impl FnOnce(&Node<'a>) -> Option<T>,
    ) -> T {
        let Some(node) = self.optional(name) else {
            return default;
        };
        read(&node).unwrap_or_else(|| {
            problems.expected(&node, what);
            default
        })
    }

    /// The tables of an optional list.
    pub(crate) fn tables(&mut self, name: &'static str, problems: &mut Problems) -> Vec<Self> {
        let Some(node) = self.optional(name) else {
            return Vec::new();
        };
        let Some(items) = node.items() else {
            problems.expected(&node, "a list of tables");
            return Vec::new();
        };
        let mut tables = Vec::with_capacity(items.len());
        for item in items {
            match item.fields() {
                Some(fields) => tables.push(fields),
                None => problems.expected(&item, "a table"),
            }
        }
        tables
    }

    /// Says something about the table itself.
    pub(crate) fn problem(&self, problems: &mut Problems, kind: SceneProblemKind, message: String) {
        problems.push(kind, self.span.clone(), self.path.clone(), message);
    }

    /// Names the fields that no one asked for.
    pub(crate) fn finish(&self, problems: &mut Problems) {
        for (name, _) in self.table {
            let text: &str = name.get_ref();
            if !self.known.contains(&text) {
                let known = self.known.join(", ");
                let message = format!(
                    "unknown field {}; the fields here are {known}",
                    quote(text.as_bytes())
                );
                let span = name.span();
                problems.push(
                    SceneProblemKind::UnknownField,
                    span,
                    self.path.clone(),
                    message,
                );
            }
        }
    }
}
