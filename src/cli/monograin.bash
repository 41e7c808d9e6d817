# Completion of monograin for bash; installed where bash-completion looks for it.

_monograin() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} options
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "run check models cite units plot atlas compare regress calibrate design data export continuum sweep sensitivity bench stress schema --help --version" -- "$current")
    return
  fi
  if [[ $previous == models ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(monograin models 2>/dev/null | awk 'NF == 0 { exit } { print $1 }') --parameters --for" -- "$current")
    return
  fi
  if [[ ${COMP_WORDS[1]} == cite && $current != -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(monograin models 2>/dev/null | awk 'NF == 0 { exit } { print $1 }')" -- "$current")
    return
  fi
  if [[ ${COMP_WORDS[1]} == stress && $previous == --model ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(monograin models 2>/dev/null | awk 'NF == 0 { exit } { print $1 }')" -- "$current")
    return
  fi
  if [[ ${COMP_WORDS[1]} == sweep && $previous == --format ]]; then
    mapfile -t COMPREPLY < <(compgen -W "csv hdf5" -- "$current")
    return
  fi
  if [[ ${COMP_WORDS[1]} == export ]] && ((COMP_CWORD == 2)); then
    mapfile -t COMPREPLY < <(compgen -W "lammps table --help" -- "$current")
    return
  fi
  if [[ $previous == --figure ]]; then
    mapfile -t COMPREPLY < <(compgen -W "svg pdf png" -- "$current")
    return
  fi
  if [[ $previous == --mesh ]]; then
    mapfile -t COMPREPLY < <(compgen -W "coarse medium fine" -- "$current")
    return
  fi
  case ${COMP_WORDS[1]} in
    run) options="--output --set --plot --figure --quiet --help" ;;
    check) options="--set --help" ;;
    models) options="--parameters --for --help" ;;
    plot) options="--output --figure --profile --vtk --x --y --unit --data --help" ;;
    atlas) options="--plots --output --figure --list --help" ;;
    compare) options="--x --y --tol --help" ;;
    calibrate) options="--output --confidence --report --figure --quiet --strict --help" ;;
    design) options="--output --figure --help" ;;
    data) options="--x --y --plot --output --figure --help" ;;
    export)
      options="--set --output --help"
      [[ ${COMP_WORDS[2]} == table ]] && options+=" --wall"
      ;;
    continuum) options="--mesh --error --keep --set --output --help" ;;
    sweep) options="--jobs --shard --format --design-only --output --figure --quiet --help" ;;
    sensitivity) options="--jobs --confidence --output --figure --help" ;;
    bench) options="--scenes --integrator --rtol --profile --against-fe --redraw --plots --output --figure --help" ;;
    stress) options="--time --seed --model --first --scenes --jobs --output --help" ;;
    regress) options="--accept --scenarios --curves --help" ;;
    *) options="--help" ;;
  esac
  if [[ ${COMP_WORDS[1]} == atlas && $current != -* && $previous != -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(monograin atlas --list 2>/dev/null | awk '{ print $1 }')" -- "$current")
    return
  fi
  if [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}

complete -o filenames -F _monograin monograin
