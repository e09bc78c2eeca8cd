//! The names of a block and their positions, derived only from its tokens, because editors request
//! names in texts that do not parse.

use proc_macro2::{Delimiter, Group, Ident, TokenStream, TokenTree};

/// The limit on the depth of nested groups.
const DEEPEST: usize = 100;

/// The scope of a block outside of sums and definitions with arguments.
pub(super) const BLOCK: usize = 0;

/// The names of a block.
#[derive(Debug, Default)]
pub(super) struct Scan {
    /// All names except those in declarations, in the order of the text; `None` where a name could
    /// be inserted.
    pub(super) names: Vec<(Option<Ident>, Place)>,
    /// The scopes, numbered from 1.
    pub(super) scopes: Vec<Scope>,
}

/// The kind of position of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// The beginning of a statement.
    Statement,
    /// An option of a statement or a reaction: `restitution`, `along`.
    Choice,
    /// A unit, or `body`.
    Unit,
    /// The constraint, limit or friction of a reaction.
    Constraint,
    /// A component after a dot.
    Component,
    /// An expression in this scope.
    Expression(usize),
}

/// The names that a sum, an integral or the left side of a definition binds.
#[derive(Debug)]
pub(super) struct Scope {
    /// The enclosing scope.
    pub(super) outer: usize,
    pub(super) names: Vec<(Ident, Binding)>,
}

/// The binding of a name in a scope.
#[derive(Debug)]
pub(super) enum Binding {
    /// An index in a range.
    Index(String),
    /// A point of a body.
    Point(String),
    /// An argument of a definition.
    Argument,
}

/// Reads a block: a struct and its statements.
pub(super) fn scan(tokens: TokenStream) -> Scan {
    let mut scan = Scan::default();
    let trees = trees(tokens);
    let end = trees.iter().position(
        |tree| matches!(tree, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace),
    );
    let statements = match end {
        Some(end) => {
            if let TokenTree::Group(group) = &trees[end] {
                let fields = inner(group);
                fields.split(|tree| is(tree, ',')).for_each(|field| scan.field(field));
            }
            &trees[end + 1..]
        }
        None => &trees[..],
    };
    statements.split(|tree| is(tree, ';')).for_each(|statement| scan.statement(statement));
    scan
}

impl Scan {
    /// Reads a field, such as `pub m: kg = 2`.
    fn field(&mut self, trees: &[TokenTree]) {
        let (kind, value) = halves(after(trees, ':'), '=');
        self.units(kind, 0);
        self.expression(value, BLOCK, 0);
    }

    fn statement(&mut self, trees: &[TokenTree]) {
        let [TokenTree::Ident(word), rest @ ..] = without_attributes(trees) else {
            self.names.push((None, Place::Statement));
            return;
        };
        self.name(word, Place::Statement);
        let mut word = word.to_string();
        let mut rest = rest;
        if word == "redundant"
            && let [TokenTree::Ident(second), others @ ..] = rest
        {
            self.name(second, Place::Statement);
            (word, rest) = (second.to_string(), others);
        }
        match (word.as_str(), rest) {
            ("coordinate" | "state" | "driven" | "input", [TokenTree::Ident(_), rest @ ..]) => {
                let (family, unit) = halves(rest, ':');
                self.expression(family, BLOCK, 0);
                self.units(unit, 0);
            }
            ("let", [TokenTree::Ident(_), rest @ ..]) => {
                let (left, value) = halves(rest, '=');
                let scope = self.bound(left);
                self.expression(value, scope, 0);
            }
            ("table", [TokenTree::Ident(_), TokenTree::Group(argument), rest @ ..]) => {
                let (left, value) = halves(rest, '=');
                self.units(after(&inner(argument), ':'), 0);
                self.units(after(left, ':'), 0);
                for part in value.split(|tree| is(tree, ',')).skip(1) {
                    let (choice, value) = halves(part, '=');
                    self.first(choice, Place::Choice);
                    self.first(value, Place::Choice);
                }
            }
            ("force" | "torque" | "rate", rest) => {
                let (left, value) = halves(rest, '=');
                let scope = self.point(left);
                self.expression(value, scope, 0);
            }
            ("output", [TokenTree::Ident(_), rest @ ..]) => {
                let (left, value) = halves(rest, '=');
                let (left, unit) = halves(left, ':');
                let scope = self.bound(left);
                self.units(unit, 0);
                self.expression(value, scope, 0);
            }
            ("constraint" | "limit" | "friction", [TokenTree::Ident(_), rest @ ..]) => {
                let (left, value) = halves(rest, ':');
                let scope = self.bound(left);
                let mut parts = value.split(|tree| is(tree, ','));
                self.expression(parts.next().unwrap_or_default(), scope, 0);
                for part in parts {
                    let (choice, value) = halves(part, '=');
                    self.first(choice, Place::Choice);
                    let rubs = matches!(choice, [TokenTree::Ident(word)] if word == "friction");
                    let along = value.iter().skip(1).position(
                        |tree| matches!(tree, TokenTree::Ident(word) if rubs && word == "along"),
                    );
                    let (value, rate) = value.split_at(along.map_or(value.len(), |own| own + 1));
                    self.expression(value, scope, 0);
                    if along.is_some() {
                        let rate = self.first(rate, Place::Choice);
                        self.expression(rate, scope, 0);
                    }
                }
            }
            ("kinetic" | "potential" | "lagrangian" | "dissipation", rest) => {
                self.expression(rest, BLOCK, 0);
            }
            _ => {}
        }
    }

    /// Reads the point on which a force acts, and opens the scope of the index of a family.
    fn point(&mut self, left: &[TokenTree]) -> usize {
        if let [name @ TokenTree::Ident(_), brackets @ TokenTree::Group(group)] = left
            && let [TokenTree::Ident(_), TokenTree::Ident(word), ..] = &inner(group)[..]
            && word == "in"
        {
            self.expression(std::slice::from_ref(name), BLOCK, 0);
            return self.bound(std::slice::from_ref(brackets));
        }
        self.expression(left, BLOCK, 0);
        BLOCK
    }

    /// Opens the scope given by the left side of a definition: `[k in 0..5]`, `(a, b)`, `[2]` or no
    /// brackets.
    fn bound(&mut self, left: &[TokenTree]) -> usize {
        let Some(TokenTree::Group(group)) = left.first() else { return BLOCK };
        let inner = inner(group);
        let names = match (group.delimiter(), &inner[..]) {
            (Delimiter::Bracket, [TokenTree::Ident(name), TokenTree::Ident(word), range @ ..])
                if word == "in" =>
            {
                self.expression(range, BLOCK, 0);
                vec![(name.clone(), Binding::Index(compact(range)))]
            }
            (Delimiter::Parenthesis, inner) => inner
                .iter()
                .filter_map(|tree| match tree {
                    TokenTree::Ident(name) => Some((name.clone(), Binding::Argument)),
                    _ => None,
                })
                .collect(),
            (_, inner) => {
                self.expression(inner, BLOCK, 0);
                return BLOCK;
            }
        };
        self.open(BLOCK, names)
    }

    /// Opens a scope and returns its number.
    fn open(&mut self, outer: usize, names: Vec<(Ident, Binding)>) -> usize {
        self.scopes.push(Scope { outer, names });
        self.scopes.len()
    }

    fn name(&mut self, name: &Ident, place: Place) {
        self.names.push((Some(name.clone()), place));
    }

    /// Reads the name at the beginning of these tokens and returns the rest.
    fn first<'t>(&mut self, trees: &'t [TokenTree], place: Place) -> &'t [TokenTree] {
        if let [TokenTree::Ident(name), rest @ ..] = trees {
            self.name(name, place);
            return rest;
        }
        self.names.push((None, place));
        trees
    }

    fn units(&mut self, trees: &[TokenTree], depth: usize) {
        for tree in trees {
            match tree {
                TokenTree::Ident(name) => self.name(name, Place::Unit),
                TokenTree::Group(group) if depth < DEEPEST => {
                    let inner = inner(group);
                    self.units(&inner, depth + 1);
                }
                _ => {}
            }
        }
        self.names.push((None, Place::Unit));
    }

    fn expression(&mut self, trees: &[TokenTree], scope: usize, depth: usize) {
        if DEEPEST <= depth {
            return;
        }
        let mut caller: Option<&Ident> = None;
        for (index, tree) in trees.iter().enumerate() {
            match tree {
                TokenTree::Ident(name) => {
                    let place = if is_component(&trees[..index]) {
                        Place::Component
                    } else {
                        Place::Expression(scope)
                    };
                    self.name(name, place);
                }
                TokenTree::Group(group) => {
                    let inner = inner(group);
                    match (caller, &inner[..]) {
                        (
                            Some(caller),
                            [TokenTree::Ident(name), TokenTree::Ident(word), rest @ ..],
                        ) if word == "in" => {
                            let (range, body) = halves(rest, ',');
                            let binding = if caller == "integral" {
                                Binding::Point(compact(range))
                            } else {
                                Binding::Index(compact(range))
                            };
                            self.expression(range, scope, depth + 1);
                            let scope = self.open(scope, vec![(name.clone(), binding)]);
                            self.expression(body, scope, depth + 1);
                        }
                        (Some(caller), inner) if caller == "reaction" => {
                            let rest = self.first(inner, Place::Constraint);
                            let (index, choice) = halves(rest, ',');
                            self.expression(index, scope, depth + 1);
                            if !choice.is_empty() {
                                self.first(choice, Place::Choice);
                            }
                        }
                        _ => self.expression(&inner, scope, depth + 1),
                    }
                }
                TokenTree::Punct(_) | TokenTree::Literal(_) => {
                    let named = matches!(trees.get(index + 1), Some(TokenTree::Ident(_)));
                    if !named && is_component(&trees[..=index]) {
                        self.names.push((None, Place::Component));
                    }
                }
            }
            caller = match tree {
                TokenTree::Ident(name) => Some(name),
                _ => None,
            };
        }
        self.names.push((None, Place::Expression(scope)));
    }
}

/// Returns the tokens of a stream. Fragments of another macro are unwrapped from their invisible
/// brackets.
fn trees(tokens: TokenStream) -> Vec<TokenTree> {
    let open = |tree| match tree {
        TokenTree::Group(group) if group.delimiter() == Delimiter::None => inner(&group),
        tree => vec![tree],
    };
    tokens.into_iter().flat_map(open).collect()
}

fn inner(group: &Group) -> Vec<TokenTree> {
    trees(group.stream())
}

/// Returns `true` if a name after these tokens is a component: the tokens end in a single dot.
fn is_component(before: &[TokenTree]) -> bool {
    match before {
        [.., first, last] => is(last, '.') && !is(first, '.'),
        _ => false,
    }
}

fn is(tree: &TokenTree, sign: char) -> bool {
    matches!(tree, TokenTree::Punct(punct) if punct.as_char() == sign)
}

/// Returns the tokens before the first occurrence of a sign, and those after it.
fn halves(trees: &[TokenTree], sign: char) -> (&[TokenTree], &[TokenTree]) {
    match trees.iter().position(|tree| is(tree, sign)) {
        Some(place) => (&trees[..place], &trees[place + 1..]),
        None => (trees, &[]),
    }
}

fn after(trees: &[TokenTree], sign: char) -> &[TokenTree] {
    halves(trees, sign).1
}

/// Returns the tokens after attributes.
fn without_attributes(trees: &[TokenTree]) -> &[TokenTree] {
    let mut rest = trees;
    while let [pound, TokenTree::Group(_), others @ ..] = rest
        && is(pound, '#')
    {
        rest = others;
    }
    rest
}

fn compact(trees: &[TokenTree]) -> String {
    trees.iter().map(ToString::to_string).collect()
}

#[cfg(test)]
mod tests {
    use super::{BLOCK, Binding, Ident, Place, scan};

    fn places(source: &str) -> Vec<(String, Place)> {
        let names = scan(source.parse().unwrap()).names.into_iter();
        names.filter_map(|(name, place)| Some((name?.to_string(), place))).collect()
    }

    fn named(list: &[(&str, Place)]) -> Vec<(String, Place)> {
        list.iter().map(|&(name, place)| (name.to_owned(), place)).collect()
    }

    #[test]
    fn names_stand_in_places() {
        let block = "struct S { m: kg, c: [m; 2] = [l, 0] } coordinate q[n]: rad;
            force q = u.x; limit rail: q >= 0, restitution = e, friction = u along v;
            output f: N = reaction(rail, friction)";
        let found = places(block);
        let expression = Place::Expression(BLOCK);
        let expected = [
            ("kg", Place::Unit),
            ("m", Place::Unit),
            ("l", expression),
            ("coordinate", Place::Statement),
            ("n", expression),
            ("rad", Place::Unit),
            ("force", Place::Statement),
            ("q", expression),
            ("u", expression),
            ("x", Place::Component),
            ("limit", Place::Statement),
            ("q", expression),
            ("restitution", Place::Choice),
            ("e", expression),
            ("friction", Place::Choice),
            ("u", expression),
            ("along", Place::Choice),
            ("v", expression),
            ("output", Place::Statement),
            ("N", Place::Unit),
            ("reaction", expression),
            ("rail", Place::Constraint),
            ("friction", Place::Choice),
        ];
        assert_eq!(found, named(&expected));
    }

    #[test]
    fn sums_and_definitions_have_scopes() {
        let found = scan(
            "struct S {} let r[k in 0..n] = sum(j in 0..k, a[j]*k); let f(a, b) = a*b;
             kinetic = integral(p in B, p.x);"
                .parse()
                .unwrap(),
        );
        let outer: Vec<usize> = found.scopes.iter().map(|scope| scope.outer).collect();
        assert_eq!(outer, [0, 1, 0, 0]);
        let text = |scope: usize| match &found.scopes[scope].names[0].1 {
            Binding::Index(range) => range.clone(),
            Binding::Point(body) => body.clone(),
            Binding::Argument => "argument".into(),
        };
        assert_eq!([0, 1, 2, 3].map(text), ["0..n", "0..k", "argument", "B"]);
        let scope = |name: &str| {
            let named = |other: &Option<Ident>| other.as_ref().is_some_and(|other| other == name);
            let place = found.names.iter().rev().find(|(other, _)| named(other)).unwrap().1;
            match place {
                Place::Expression(scope) => scope,
                _ => usize::MAX,
            }
        };
        assert_eq!(["n", "j", "k", "b", "p"].map(scope), [0, 2, 2, 3, 4]);
    }

    /// A block is scanned while it is being typed.
    #[test]
    fn texts_that_do_not_parse_have_names() {
        let expression = Place::Expression(BLOCK);
        let statement = Place::Statement;
        assert_eq!(places("struct S {} kine"), named(&[("kine", statement)]));
        let unfinished = "struct S {} potential = m*g* kinetic = 1;";
        let expected = [
            ("potential", statement),
            ("m", expression),
            ("g", expression),
            ("kinetic", expression),
        ];
        assert_eq!(places(unfinished), named(&expected));
        assert_eq!(
            places("struct S { m: k } force"),
            named(&[("k", Place::Unit), ("force", statement)])
        );
        assert!(places("").is_empty());
        // Positions where a name could be inserted: after `q +`, in `sin()`, after `r.`, and as a
        // new statement.
        let open = "struct S {} kinetic = q + ; potential = sin() + r. + q; ";
        let open: Vec<Place> = scan(open.parse().unwrap())
            .names
            .into_iter()
            .filter_map(|(name, place)| name.is_none().then_some(place))
            .collect();
        let component = Place::Component;
        assert_eq!(
            open,
            [Place::Unit, expression, expression, expression, component, expression, statement]
        );
        let deep = format!("struct S {{}} kinetic = {}q{};", "(".repeat(1000), ")".repeat(1000));
        assert_eq!(places(&deep), named(&[("kinetic", statement)]));
    }
}
