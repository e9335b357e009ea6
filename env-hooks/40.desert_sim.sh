# setup.bash lets desert_run and the other programs be called by their names alone.
case ":$PATH:" in
  *":$CATKIN_ENV_HOOK_WORKSPACE/lib/desert_sim:"*) ;;
  *) export PATH="$CATKIN_ENV_HOOK_WORKSPACE/lib/desert_sim:$PATH" ;;
esac
