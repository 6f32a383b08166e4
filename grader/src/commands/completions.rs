//! `grader completions`.

use std::process::ExitCode;

use clap_complete::Shell;

use present::streams::print;
use verdict::error::Result;

/// Print shell completions for bash, elvish, fish, powershell or zsh
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Shell to print completions for
    shell: Shell,
}

pub(super) fn run(arguments: &Arguments, mut command_line: clap::Command) -> Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command_line, "grader", &mut script);
    clap_complete::generate(arguments.shell, &mut arty::cli::command_line(), "arty", &mut script);
    print(String::from_utf8_lossy(&script) + of_cargo(arguments.shell))?;
    Ok(ExitCode::SUCCESS)
}

/// Completions of Cargo's aliases, since neither program is on the search path of who runs them through Cargo. All other
/// commands of Cargo are completed as before.
fn of_cargo(shell: Shell) -> &'static str {
    match shell {
        Shell::Bash => BASH,
        Shell::Zsh => ZSH,
        Shell::Fish => FISH,
        _ => "",
    }
}

const BASH: &str = r#"
_arty_before=$(complete -p cargo 2>/dev/null | sed -n 's/.* -F \([^ ]*\) .*/\1/p')
_arty_of_cargo() {
    local before=$_arty_before
    case "${COMP_WORDS[1]}" in
        grade|hint)
            COMP_WORDS=(grader "${COMP_WORDS[@]:1}")
            _grader grader "$2" "$3" ;;
        grader|arty)
            local name=${COMP_WORDS[1]}
            COMP_WORDS=("${COMP_WORDS[@]:1}")
            COMP_CWORD=$((COMP_CWORD - 1))
            "_$name" "$name" "$2" "$3" ;;
        *)
            if [ -n "$before" ] && [ "$before" != _arty_of_cargo ] && declare -F "$before" >/dev/null; then
                "$before" "$@"
            elif [ "$COMP_CWORD" = 1 ]; then
                COMPREPLY=($(compgen -W "arty grade grader hint view api build check doc run test" -- "$2"))
            fi ;;
    esac
}
complete -o bashdefault -o default -F _arty_of_cargo cargo
"#;

const ZSH: &str = r#"
_arty_of_cargo() {
    case "${words[2]}" in
        grade|hint) words[1]=grader; _grader ;;
        grader|arty) shift words; (( CURRENT-- )); "_${words[1]}" ;;
        *) (( $+functions[_cargo] )) && _cargo || autoload -Uz _cargo && _cargo ;;
    esac
}
compdef _arty_of_cargo cargo
"#;

const FISH: &str = r#"
function __arty_of_cargo
    set -l line (commandline -cp | string replace -r '^cargo +' '' | string replace -r '^(grade|hint)\b' 'grader $1')
    complete -C "$line"
end
complete -c cargo -n '__fish_seen_subcommand_from grade hint grader arty' -f -a '(__arty_of_cargo)'
complete -c cargo -n '__fish_use_subcommand' -a 'arty grade grader hint view api'
"#;
