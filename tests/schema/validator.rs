//! A validator for the part of JSON Schema that `docs/schema` uses.

use serde_json::Value;

/// What does not fit, if something does not.
pub(super) fn problem(schema: &Value, line: &Value) -> Option<String> {
    Validator { root: schema }.check(schema, line, "$").err()
}

struct Validator<'s> {
    root: &'s Value,
}

impl Validator<'_> {
    fn check(&self, schema: &Value, value: &Value, at: &str) -> Result<(), String> {
        for (keyword, rule) in schema.as_object().unwrap() {
            let fits = match keyword.as_str() {
                "$schema" | "$defs" | "title" | "description" => true,
                // They belong to `properties`.
                "additionalProperties" | "required" if !value.is_object() => true,
                "properties" | "additionalProperties" => {
                    self.check_properties(schema, value, at)?;
                    true
                }
                "required" => {
                    let missing = rule
                        .as_array()
                        .unwrap()
                        .iter()
                        .find(|key| value.get(key.as_str().unwrap()).is_none());
                    match missing {
                        None => true,
                        Some(key) => return Err(format!("{at}: there is no {key}")),
                    }
                }
                "const" => value == rule,
                "enum" => rule.as_array().unwrap().contains(value),
                "type" => match rule {
                    Value::Array(types) => types.iter().any(|one| is_of(value, one)),
                    one => is_of(value, one),
                },
                "minimum" => value.as_f64().is_none_or(|it| it >= rule.as_f64().unwrap()),
                "minItems" => {
                    value.as_array().is_none_or(|it| it.len() as u64 >= rule.as_u64().unwrap())
                }
                "maxItems" => {
                    value.as_array().is_none_or(|it| it.len() as u64 <= rule.as_u64().unwrap())
                }
                "items" => {
                    for (index, item) in value.as_array().into_iter().flatten().enumerate() {
                        self.check(rule, item, &format!("{at}[{index}]"))?;
                    }
                    true
                }
                "$ref" => {
                    let pointer = rule.as_str().unwrap().strip_prefix('#').unwrap();
                    self.check(self.root.pointer(pointer).unwrap(), value, at)?;
                    true
                }
                "oneOf" => {
                    let results: Vec<_> = rule
                        .as_array()
                        .unwrap()
                        .iter()
                        .map(|one| (one, self.check(one, value, at)))
                        .collect();
                    let of_kind = results.iter().find(|(one, _)| {
                        let kind = &one["properties"]["kind"]["const"];
                        kind.is_string() && *kind == value["kind"]
                    });
                    match results.iter().filter(|(_, result)| result.is_ok()).count() {
                        1 => true,
                        // The alternative of the line's kind names the problem best.
                        0 if of_kind.is_some() => return of_kind.unwrap().1.clone(),
                        _ => false,
                    }
                }
                other => panic!("{at}: `{other}` is not supported"),
            };
            if !fits {
                return Err(format!("{at}: {value} does not fit {keyword} {rule}"));
            }
        }
        Ok(())
    }

    fn check_properties(&self, schema: &Value, value: &Value, at: &str) -> Result<(), String> {
        for (key, inside) in value.as_object().into_iter().flatten() {
            let at = format!("{at}.{key}");
            match (schema["properties"].get(key), &schema["additionalProperties"]) {
                (Some(rule), _) => self.check(rule, inside, &at)?,
                (None, Value::Bool(false)) => return Err(format!("{at} is not in the schema")),
                (None, others) => self.check(others, inside, &at)?,
            }
        }
        Ok(())
    }
}

fn is_of(value: &Value, name: &Value) -> bool {
    match name.as_str().unwrap() {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => {
            value.is_u64() || value.is_i64() || value.as_f64().is_some_and(|it| it.fract() == 0.0)
        }
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("`{other}` is not a type"),
    }
}
